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
// A flock that fills its bounding box more or less goes into a grid (simulate/flock/near_grid.h).
// In one that is scattered, nearly all animals have nobody near. A hashed table with a byte for
// every cell of a lattice tells most of them from the rest: cells are wider than twice the largest
// d_ij, so an animal's own cell and the nearer neighbours, eight in all, hold everybody who may be
// too near. Only those with company go into a second, exact table. Linear in animals, whatever the
// extent of the scene, and fastest when neighbours in space are neighbours in memory. One room far
// larger than the others makes it slow.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MINIMUM_DISTANCE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MINIMUM_DISTANCE_H_

#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/core/vec3.h"
#include "simulate/flock/near_grid.h"

namespace flocklift {

template <typename T>
class MinimumDistance {
 public:
  // Returns how many animals were moved.
  std::int64_t Enforce(std::span<const Crowd<T>> crowds, ThreadPool* pool);

 private:
  struct Place {
    T x, y, z, room;
  };

  std::int64_t EnforceInGrid(std::span<const Crowd<T>> crowds, ThreadPool* pool);
  void Gather(std::span<const Crowd<T>> crowds, ThreadPool* pool);
  void NumberCells(std::span<const Crowd<T>> crowds, T per_cell, T shift, ThreadPool* pool);
  void Enter(ThreadPool* pool);
  bool HasCompany(std::uint32_t lowest) const;
  void FindCompany(ThreadPool* pool);
  void Chain(T per_cell);
  Vec3<T> Push(std::size_t self, bool* touched) const;

  NearGrid<T> grid_;
  std::vector<Place> places_;                        // of all animals
  std::vector<std::uint32_t> cell_;                  // of each animal, before it is hashed
  std::vector<std::uint8_t> entries_;                // of the first table: who is in each cell
  std::vector<std::vector<std::uint32_t>> company_;  // those with company, by chunk of animals
  std::vector<std::uint32_t> crowded_;               // the same, all
  std::vector<Place> close_;                         // of crowded_
  std::vector<std::int32_t> head_, next_;            // chains of crowded_ by bucket; -1: the end
  std::vector<Vec3<T>> push_;                        // of crowded_ [m]
  std::vector<std::uint8_t> touched_;                // of crowded_, or of all animals in the grid
};

extern template class MinimumDistance<float>;
extern template class MinimumDistance<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MINIMUM_DISTANCE_H_
