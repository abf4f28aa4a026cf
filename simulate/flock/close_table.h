// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// All pairs of animals that are nearer than they may be, among those with company
// (simulate/flock/company.h), for minimum-distance enforcement (simulate/flock/minimum_distance.h):
// sorted by the cells of the company's lattice, whose numbers are cut to a table of buckets
// (counting sort, stable). The eight cells that hold all of an animal's company are four runs of
// two buckets each; it is tested against those in them that come behind it, so every pair once.
// However widely a flock is scattered, this stays linear in animals; only crowds in one cell cost
// their square.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_CLOSE_TABLE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_CLOSE_TABLE_H_

#include <cstdint>
#include <vector>

#include "simulate/flock/company.h"
#include "simulate/flock/crowd.h"

namespace flocklift {

template <typename T>
class CloseTable {
 public:
  // Sorts those with company.
  void Sort(const Company<T>& company);
  // The pairs nearer than the sum of their rooms, in an order that depends on the positions alone.
  void FindPairs();

  const std::vector<ClosePair<T>>& pairs() const { return pairs_; }
  // Which animal, counted through all crowds, is at a place of the sort.
  std::uint32_t Animal(std::uint32_t place) const { return animal_[place]; }

 private:
  void AppendPairs(std::uint32_t first);

  std::uint32_t mask_ = 0, across_y_ = 0, across_z_ = 0;
  std::vector<std::uint32_t> next_;          // place in each bucket, while sorting
  std::vector<std::uint32_t> start_;         // of each bucket's run; at the end twice the end
  std::vector<T> x_, y_, z_, room_;          // sorted, padded
  std::vector<std::uint32_t> animal_, low_;  // sorted: who it is, the lowest of its eight cells
  std::vector<std::uint32_t> has_;           // animals with somebody too near behind
  std::vector<ClosePair<T>> pairs_;
};

extern template class CloseTable<float>;
extern template class CloseTable<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_CLOSE_TABLE_H_
