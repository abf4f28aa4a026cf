// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The queue of a marching front where nearly the right order will do: nodes by their cost in
// buckets of a certain width, those of the cheapest bucket first, in any order within it (untidy
// fast marching: L. Yatziv, A. Bartesaghi, G. Sapiro, "O(N) implementation of the fast marching
// algorithm", J. Comput. Phys. 212, 2006). A node whose cost falls is pushed again, and whoever
// pops an entry compares it with the node's cost: older ones are stale.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_COST_BUCKETS_H_
#define FLOCKLIFT_SIMULATE_FIELDS_COST_BUCKETS_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flocklift::internal {

class CostBuckets {
 public:
  struct Entry {
    float cost;
    std::uint32_t node;
  };

  // Empties it; `width` of a bucket, > 0. What costs more than kMost buckets is kept in the last.
  void Clear(float width) {
    for (std::vector<Entry>& bucket : buckets_) bucket.clear();
    width_ = width;
    least_ = entries_ = 0;
  }
  bool Empty() const { return entries_ == 0; }
  // No entry costs less.
  float LeastCost() const { return static_cast<float>(least_) * width_ * kBelow; }

  void Push(float cost, std::uint32_t node) {
    const std::size_t bucket =
        static_cast<std::size_t>(std::min(cost / width_, static_cast<float>(kMost - 1)));
    if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
    buckets_[bucket].push_back({cost, node});
    least_ = entries_++ == 0 ? bucket : std::min(least_, bucket);
  }

  Entry Pop() {
    const Entry entry = buckets_[least_].back();
    buckets_[least_].pop_back();
    if (--entries_ > 0) {
      while (buckets_[least_].empty()) ++least_;
    }
    return entry;
  }

 private:
  static constexpr std::size_t kMost = 1U << 16U;
  static constexpr float kBelow = 1 - 1e-6F;  // against rounding

  std::vector<std::vector<Entry>> buckets_;
  float width_ = 1;
  std::size_t least_ = 0, entries_ = 0;  // the first that may hold something; in all
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_FIELDS_COST_BUCKETS_H_
