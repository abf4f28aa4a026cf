// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Minimum-distance enforcement (A. Treuille, S. Cooper, Z. Popovic, "Continuum crowds", SIGGRAPH
// 2006; equations.md, section 5): after the move, any two animals nearer than they may be are
// pushed apart along the line between them, each by half of what is missing:
//   x_i -= sum_j (d_ij - |r|) / 2  r / |r|,    r = x_j - x_i,  |r| < d_ij = room_i + room_j
// All pairs count, across cells and species, and all pushes are those of the positions before: the
// result does not depend on threads. Animals in the very same place part along x. One pass, as
// published; in a crush some are still too near afterwards.
//
// Where nearly all animals have nobody near, a bit for every cell of a lattice tells most of them
// from the rest, and only those with company are looked at, patch by patch
// (simulate/flock/near_patches.h). So it is where a flock is so scattered that the cells of a grid
// would hold crowds; all others are in a grid (simulate/flock/near_grid.h). Linear in animals,
// whatever the extent of the scene, and fastest when neighbours in space are neighbours in memory.
// One room far larger than the others makes it slow.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MINIMUM_DISTANCE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MINIMUM_DISTANCE_H_

#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/core/vec3.h"
#include "simulate/flock/crowd.h"
#include "simulate/flock/near_grid.h"
#include "simulate/flock/near_patches.h"

namespace flocklift {

template <typename T>
class MinimumDistance {
 public:
  // Returns how many animals were moved. `boxes` are those of BoxesOf, or around these.
  std::int64_t Enforce(std::span<const Crowd<T>> crowds, std::span<const CrowdBox<T>> boxes,
                       ThreadPool* pool);
  std::int64_t Enforce(std::span<const Crowd<T>> crowds, ThreadPool* pool) {
    return Enforce(crowds, BoxesOf(crowds, pool), pool);
  }

 private:
  template <typename Pairs>
  std::int64_t PushApart(const Pairs& sorted, std::span<const Crowd<T>> crowds);

  NearGrid<T> grid_;
  NearPatches<T> patches_;
  std::vector<std::uint8_t> touched_;  // of all animals
};

extern template class MinimumDistance<float>;
extern template class MinimumDistance<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MINIMUM_DISTANCE_H_
