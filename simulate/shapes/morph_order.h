// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Who leaves first and who fills which place (equations.md, section 7): along a path with the key
// points Q_0 .. Q_{m+1}
//   D1(x)  = (Q_0 - Q_1) . (x - Q_1)             ascending: those in front leave first
//   D2(x') = -(Q_{m+1} - Q_m) . (x' - Q_m)       ascending: the farthest places fill first
// and the k-th to leave takes the k-th place.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_MORPH_ORDER_H_
#define FLOCKLIFT_SIMULATE_SHAPES_MORPH_ORDER_H_

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

// Indices of the points in ascending order of way . p; equal ones keep their order.
inline std::vector<std::uint32_t> OrderAlong(const Vec3d& way, std::span<const Vec3d> points) {
  std::vector<double> key;
  key.reserve(points.size());
  for (const Vec3d& p : points) key.push_back(Dot(way, p));
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
  return order;
}

// `path` are the key points, at least two [m]; the constant part of D does not change the order.
inline std::vector<std::uint32_t> DepartureOrder(std::span<const Vec3d> path,
                                                 std::span<const Vec3d> sources) {
  return OrderAlong(path[0] - path[1], sources);
}
inline std::vector<std::uint32_t> ArrivalOrder(std::span<const Vec3d> path,
                                               std::span<const Vec3d> targets) {
  return OrderAlong(path[path.size() - 2] - path.back(), targets);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_MORPH_ORDER_H_
