// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One species while it runs, as motions see it (simulate/flock/motion.h).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_HERD_H_
#define FLOCKLIFT_SIMULATE_FLOCK_HERD_H_

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/flock/bodies.h"
#include "simulate/flock/cell_grid.h"

namespace flocklift {

template <typename T>
Vec3<T> Cast(const Vec3d& v) {
  return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}
template <typename T>
Vec3d ToDouble(const Vec3<T>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
// A scene of two dimensions keeps z at 0.
template <typename T>
Vec3<T> Flattened(bool flat, Vec3<T> v) {
  if (flat) v.z = T(0);
  return v;
}

inline constexpr std::int64_t kRowGrain = 8;       // rows of cells a chunk of work
inline constexpr std::int64_t kAgentGrain = 1024;  // animals a chunk of work

template <typename T>
struct Herd {
  std::string species;
  std::uint64_t first_agent = 0;  // of this species among all animals
  Bodies<T> now;                  // the state, in the order of the last sort
  Bodies<T> sorted;               // room for the next order
  CellGrid<T> grid;               // of `sorted`
  std::vector<T> cruising_speed;  // by agent [m/s]
  std::vector<T> radius;          // by agent, of the body [m]
  std::vector<T> ax, ay, az;      // of the last step, in the order of `now` [m/s^2]
  std::vector<T> neighbours;      // likewise, how many each had

  std::size_t size() const { return now.size(); }
  Vec3<T> Acceleration(std::size_t k) const { return {ax[k], ay[k], az[k]}; }
  void SetAcceleration(std::size_t k, const Vec3<T>& a) {
    ax[k] = a.x;
    ay[k] = a.y;
    az[k] = a.z;
  }

  // Brings `now` into the order of cells at least `reach` wide. All of an animal's neighbours
  // within reach are then in its own cell and the 26 around it (ForEachInRows).
  void SortBy(double reach, ThreadPool* pool = nullptr) {
    grid.Sort(now, reach, &sorted, pool);
    std::swap(now, sorted);
  }
};

// Calls fn(k, for_neighbours) for each animal k of the rows of cells first_row .. last_row - 1;
// for_neighbours(visit) calls visit(j) for all that may be within reach, in the order of the sort.
template <typename T, typename Function>
void ForEachInRows(const Herd<T>& herd, std::int64_t first_row, std::int64_t last_row,
                   const Function& fn) {
  const auto g = herd.grid.view();
  for (auto row = static_cast<int>(first_row); row < last_row; ++row) {
    const int b = 1 + row % g.ny, c = 1 + row / g.ny;
    for (std::uint32_t k = g.start[g.Cell(1, b, c)]; k < g.start[g.Cell(g.nx, b, c) + 1]; ++k) {
      const int a = g.CellX(herd.now.x[k]);
      fn(k, [&](const auto& neighbour) {
        CellGrid<T>::ForEachRun(g, a, a, b, c, [&](std::uint32_t first, std::uint32_t last) {
          for (std::uint32_t j = first; j < last; ++j) {
            if (j != k) neighbour(j);
          }
        });
      });
    }
  }
}

// The same for all rows, on all threads.
template <typename T, typename Function>
void ForEachWithNeighbours(const Herd<T>& herd, ThreadPool* pool, const Function& fn) {
  pool->For(0, herd.grid.view().RowCount(), kRowGrain,
            [&](std::int64_t first, std::int64_t last) { ForEachInRows(herd, first, last, fn); });
}

// fn(k) for every animal, on all threads.
template <typename T, typename Function>
void ForEachAnimal(const Herd<T>& herd, ThreadPool* pool, const Function& fn) {
  pool->For(0, static_cast<std::int64_t>(herd.size()), kAgentGrain,
            [&](std::int64_t first, std::int64_t last) {
              for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last);
                   ++k) {
                fn(k);
              }
            });
}

// In the order of the animals, one thread: the same sum always.
template <typename T>
Vec3d SumOfPositions(const Bodies<T>& bodies) {
  Vec3d sum;
  for (std::size_t k = 0; k < bodies.size(); ++k) sum += ToDouble(bodies.Position(k));
  return sum;
}

// In an order that depends on nothing, in lanes so that it does not wait for itself.
template <typename T>
double SumOf(const T* values, std::size_t n) {
  constexpr std::size_t kLanes = 8;
  double lanes[kLanes] = {}, sum = 0;
  const std::size_t whole = n - n % kLanes;
  for (std::size_t k = 0; k < whole; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      lanes[lane] += static_cast<double>(values[k + lane]);
    }
  }
  for (std::size_t k = whole; k < n; ++k) sum += static_cast<double>(values[k]);
  for (const double lane : lanes) sum += lane;
  return sum;
}

// The same at any number of threads: sums of chunks, in their order. Each thread adds what it has
// most likely counted itself.
template <typename T>
double SumOfNeighbours(const Herd<T>& herd, ThreadPool* pool) {
  const auto n = static_cast<std::int64_t>(herd.size());
  std::vector<double> sums(static_cast<std::size_t>((n + kAgentGrain - 1) / kAgentGrain));
  pool->For(0, n, kAgentGrain, [&](std::int64_t first, std::int64_t last) {
    sums[static_cast<std::size_t>(first / kAgentGrain)] =
        SumOf(herd.neighbours.data() + first, static_cast<std::size_t>(last - first));
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_HERD_H_
