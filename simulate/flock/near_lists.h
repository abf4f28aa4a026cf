// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Who is near whom, written out: for each animal of a sorted swarm the numbers of all others within
// reach, in the order of the sort. Worth it where a list is used more than once, over several terms
// or (Verlet lists, simulate/flock/verlet_lists.h) several steps.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_NEAR_LISTS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_NEAR_LISTS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/flock/bodies.h"
#include "simulate/flock/cell_grid.h"
#include "simulate/flock/kernels/kernels.h"

namespace flocklift {

inline constexpr std::int64_t kListGrain = 512;  // animals a chunk of work

// Within reach is who is no farther than `straight`, or nearer than `manhattan` by that distance
// [m].
template <typename T>
struct NearReach {
  T straight, manhattan;

  bool Holds(const Vec3<T>& dx) const {
    using std::abs;
    return Dot(dx, dx) <= straight * straight || abs(dx.x) + abs(dx.y) + abs(dx.z) < manhattan;
  }
  // The Manhattan distance is never less than the Euclidean.
  double Farthest() const { return std::max<double>(straight, manhattan); }
};

// The lists of consecutive animals, eight side by side as the lanes of a pack take them: neighbour
// n of animal k is places[8 (begin[k / 8] + n) + k % 8]. Up to the longest of the eight, lists are
// filled with nobody: the number of a row behind the last animal's.
struct NearLists {
  explicit NearLists(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : places(memory) {}

  std::vector<std::uint32_t> begin;        // one more than there are eights
  std::pmr::vector<std::uint32_t> places;  // at least 8 begin.back(); the rest is room

  void Clear() { begin.assign(1, 0); }
  // Room for what most lists of kListGrain animals take, ahead of the first.
  void Reserve() { places.resize(kFirstRoom); }

  static constexpr std::size_t kFirstRoom = std::size_t{1} << 15U;  // places
};

// Appends the lists of the animals from `first` on, up to last - 1 or until `places` is full (then
// call again: it grows); returns the first that is not listed yet, `last` or some eights after
// `first`. A null kernel, or a scalar that
// is not float, goes pair by pair.
template <typename T>
std::uint32_t ListNear(const CellGrid<T>& grid, const Bodies<T>& bodies, const NearReach<T>& reach,
                       const KernelVariant* kernel, std::uint32_t first, std::uint32_t last,
                       NearLists* lists);

// An animal's state side by side, to be fetched by number; the rows behind the last animal's, as
// many as fill a pack, are nobody's, who is far away.
template <typename T>
struct alignas(8 * sizeof(T)) BodyRow {
  T x, y, z, none, vx, vy, vz, also_none;

  Vec3<T> Position() const { return {x, y, z}; }
  Vec3<T> Velocity() const { return {vx, vy, vz}; }
};
// Room for the rows of n animals, with nobody behind them.
template <typename T>
void MakeRoom(std::size_t n, std::vector<BodyRow<T>>* rows);
// Those of the animals first .. last - 1, or of all.
template <typename T>
void FillRows(const Bodies<T>& bodies, std::size_t first, std::size_t last,
              std::vector<BodyRow<T>>* rows);
template <typename T>
void FillRows(const Bodies<T>& bodies, ThreadPool* pool, std::vector<BodyRow<T>>* rows);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_NEAR_LISTS_H_
