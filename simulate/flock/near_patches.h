// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// All pairs of animals that are nearer than they may be, for minimum-distance enforcement
// (simulate/flock/minimum_distance.h) in a flock where nearly all have nobody near. Animals that
// follow each other in memory are mostly neighbours in space; so the flock is cut into patches of
// them, and each is searched by itself, with those of later patches that are within reach of its
// box: by bits (simulate/flock/company.h) and a table (simulate/flock/close_table.h) of its own.
// Threads share nothing but positions, and a patch's bits stay in a near cache. The cut depends on
// the flock alone, and so does the order of the pairs. A flock whose patches lie in each other is
// searched as one.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_NEAR_PATCHES_H_
#define FLOCKLIFT_SIMULATE_FLOCK_NEAR_PATCHES_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/flock/crowd.h"

namespace flocklift {

template <typename T>
class NearPatches {
 public:
  // The pairs nearer than the sum of their rooms. `boxes` are those of BoxesOf, `reach` is the
  // largest distance asked for, above 0 [m].
  void FindPairs(std::span<const Crowd<T>> crowds, std::span<const CrowdBox<T>> boxes, T reach,
                 ThreadPool* pool);

  // By patch; animals are counted through all crowds.
  const std::vector<std::vector<ClosePair<T>>>& pairs() const { return pairs_; }
  // Who is meant in a pair, as NearGrid tells it of the places of its sort.
  static std::uint32_t Animal(std::uint32_t animal) { return animal; }

 private:
  // As many as have a box: animals first .. first + animals.size - 1.
  struct Piece {
    Crowd<T> animals;
    std::uint32_t first;
  };
  struct Patch;

  // The patch of pieces first .. last - 1; false if too many others lie in it.
  bool Search(std::span<const CrowdBox<T>> boxes, T reach, std::size_t first, std::size_t last,
              std::vector<ClosePair<T>>* pairs) const;

  std::vector<Piece> pieces_;
  std::vector<std::vector<ClosePair<T>>> pairs_;
};

extern template class NearPatches<float>;
extern template class NearPatches<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_NEAR_PATCHES_H_
