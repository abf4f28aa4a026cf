// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// All pairs of animals that are nearer than they may be, for minimum-distance enforcement
// (simulate/flock/minimum_distance.h), where a grid over all animals suits them: their copies are
// sorted by cell (counting sort; x fastest, then y, z; stable), cells are at least as wide as the
// largest distance asked for, and about half an animal each or fewer. An animal is tested against
// those behind it in its own and the next cell, and, where it is near enough to the cell's rim,
// against three cells in each of the four rows that follow: half of the neighbourhood, so every
// pair once. A flock scattered so widely that cells would hold crowds is refused.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_NEAR_GRID_H_
#define FLOCKLIFT_SIMULATE_FLOCK_NEAR_GRID_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/core/vec3.h"
#include "simulate/flock/crowd.h"

namespace flocklift {

template <typename T>
class NearGrid {
 public:
  // Sorts the animals in the box around them. `reach` is the largest distance asked for, above 0
  // [m]. False if the flock does not suit a grid.
  bool Sort(std::span<const Crowd<T>> crowds, const CrowdBox<T>& box, T reach, ThreadPool* pool);
  // The pairs nearer than the sum of their rooms, in an order that depends on the positions alone.
  void FindPairs(ThreadPool* pool);

  // By chunk of animals.
  const std::vector<std::vector<ClosePair<T>>>& pairs() const { return pairs_; }
  // Which animal, counted through all crowds, is at a place of the sort.
  std::uint32_t Animal(std::uint32_t place) const { return animal_[place]; }

 private:
  bool ChooseCells(const CrowdBox<T>& box, T reach);
  void NumberCells(std::span<const Crowd<T>> crowds, ThreadPool* pool);
  bool Count();
  void AppendPairs(std::uint32_t first, std::vector<ClosePair<T>>* pairs) const;

  std::size_t n_ = 0;
  Vec3<T> low_;
  T per_cell_ = 0;
  T rim_ = 0;                     // part of a cell beyond which an animal is at its upper rim
  bool wide_ = false;             // cells far wider than asked for
  int nx_ = 0, ny_ = 0, nz_ = 0;  // cells without the empty ones around
  std::vector<std::uint32_t> cell_, rank_;       // by animal; rank within the cell
  std::vector<std::uint32_t> start_;             // of each cell's run; the next entry is its end
  std::vector<T> x_, y_, z_, room_;              // sorted, padded
  std::vector<std::uint32_t> place_, animal_;    // sorted: the cell, and who it is
  std::vector<std::vector<std::uint32_t>> has_;  // animals with somebody too near behind, by chunk
  std::vector<std::vector<ClosePair<T>>> pairs_;
};

extern template class NearGrid<float>;
extern template class NearGrid<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_NEAR_GRID_H_
