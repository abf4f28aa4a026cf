// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pair forces of a flock, for tests: sorted, summed, and told by animal.

#ifndef FLOCKLIFT_TESTS_SIMULATE_FLOCK_PAIR_SUMS_H_
#define FLOCKLIFT_TESTS_SIMULATE_FLOCK_PAIR_SUMS_H_

#include <string>
#include <type_traits>
#include <vector>

#include "simulate/flock/pair_forces.h"
#include "simulate/flock/shape_sums.h"
#include "tests/simulate/flock/flocks.h"

namespace flocklift {

struct ByAnimal {
  std::vector<Vec3d> acceleration;
  std::vector<double> neighbours;

  friend bool operator==(const ByAnimal&, const ByAnimal&) = default;
};

template <typename T>
struct SortedFlock {
  CellGrid<T> grid;
  Bodies<T> bodies;
  std::vector<RowSample> rows;
  NeighbourLists nearest;

  SortedFlock(const NamedFlock& flock, double reach, std::uint32_t most = 0) {
    grid.Sort(AsBodies<T>(flock), reach, &bodies);
    if (most > 0) SampleRows(grid, most, 7, &rows);
  }

  template <typename Parameters>
  ByAnimal Sum(const Parameters& p, const std::string& kernel, int threads = 1) const {
    const std::size_t n = bodies.size();
    std::vector<T> columns[4];
    for (std::vector<T>& column : columns) column.assign(n + Bodies<T>::kPadding, T(-1));
    ThreadPool pool(threads);
    const PairTask<T> task{grid,
                           bodies,
                           columns[0],
                           columns[1],
                           columns[2],
                           columns[3],
                           rows.empty() ? nullptr : &rows,
                           nearest.empty() ? nullptr : &nearest};
    if constexpr (std::is_same_v<Parameters, ShapePairNumbers>) {
      std::vector<BodyRow<T>> room;
      SumPairs<T>(p, ChooseKernel(kernel), task, nullptr, &pool, &room);
    } else {
      SumPairs<T>(p, ChooseKernel(kernel), task, &pool);
    }
    ByAnimal result{std::vector<Vec3d>(n), std::vector<double>(n)};
    for (std::size_t k = 0; k < n; ++k) {
      const auto d = [&](int c) { return static_cast<double>(columns[c][k]); };
      result.acceleration[bodies.agent[k]] = {d(0), d(1), d(2)};
      result.neighbours[bodies.agent[k]] = d(3);
    }
    return result;
  }
};

inline BoidsParameters<double> BlindRules(double blind, double taper = 0, double view_taper = 0) {
  BoidsParameters<double> p = PlainRules(0.4, 1.05, taper);
  p.blind = blind;
  p.blind_taper = view_taper;
  return p;
}

inline SteerParameters SteerRules(double radius, double taper = 0, double view_taper = 0) {
  SteerParameters p;
  p.separation.radius = 5.0 / 9 * radius;
  p.alignment.radius = 7.5 / 9 * radius;
  p.cohesion.radius = radius;
  p.near = 1.5 / 9 * radius;
  p.taper = taper;
  p.view_taper = view_taper;
  return p;
}

// Velocities to headings.
inline NamedFlock Headings(NamedFlock flock) {
  for (Vec3d& v : flock.velocity) v = Normalized(v);
  return flock;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_FLOCK_PAIR_SUMS_H_
