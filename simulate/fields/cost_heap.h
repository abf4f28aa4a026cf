// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The heap of a marching front: nodes by their cost, the least first. A node whose cost falls is
// pushed again, and whoever pops an entry compares it with the node's cost: older ones are stale.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_COST_HEAP_H_
#define FLOCKLIFT_SIMULATE_FIELDS_COST_HEAP_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flocklift::internal {

class CostHeap {
 public:
  struct Entry {
    float cost;
    std::uint32_t node;
  };

  bool Empty() const { return entries_.empty(); }
  void Clear() { entries_.clear(); }
  float LeastCost() const { return entries_.front().cost; }

  // Four children each: shallower than with two, and the children share a cache line.
  void Push(float cost, std::uint32_t node) {
    std::size_t at = entries_.size();
    entries_.push_back({cost, node});
    while (at > 0) {
      const std::size_t parent = (at - 1) / 4;
      if (!(cost < entries_[parent].cost)) break;
      entries_[at] = entries_[parent];
      at = parent;
    }
    entries_[at] = {cost, node};
  }

  Entry Pop() {
    const Entry top = entries_.front(), last = entries_.back();
    entries_.pop_back();
    const std::size_t size = entries_.size();
    if (size == 0) return top;
    std::size_t at = 0;
    for (std::size_t child; (child = 4 * at + 1) < size;) {
      const std::size_t end = std::min(child + 4, size);
      std::size_t least = child;
      for (++child; child < end; ++child) {
        if (entries_[child].cost < entries_[least].cost) least = child;
      }
      if (!(entries_[least].cost < last.cost)) break;
      entries_[at] = entries_[least];
      at = least;
    }
    entries_[at] = last;
    return top;
  }

 private:
  std::vector<Entry> entries_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_FIELDS_COST_HEAP_H_
