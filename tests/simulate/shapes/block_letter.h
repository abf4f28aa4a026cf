// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Closed surfaces for tests: a prism over a polygon, and a ball.

#ifndef FLOCKLIFT_TESTS_SIMULATE_SHAPES_BLOCK_LETTER_H_
#define FLOCKLIFT_TESTS_SIMULATE_SHAPES_BLOCK_LETTER_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "simulate/core/triangle_mesh.h"

namespace flocklift {

// The union of unit squares [i, i + 1] x [j, j + 1], extruded from z = 0 to height: letters of
// blocks, with right angles both ways.
inline TriangleMesh BlockLetter(const std::vector<std::array<int, 2>>& squares, double height) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> names;
  const auto name = [&](int i, int j, int level) {
    const auto [entry, fresh] =
        names.try_emplace({i, j, level}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.push_back({i * 1.0, j * 1.0, level * height});
    return entry->second;
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  const auto has = [&](int i, int j) {
    for (const auto& square : squares) {
      if (square[0] == i && square[1] == j) return true;
    }
    return false;
  };
  for (const auto& [i, j] : squares) {
    quad(name(i, j, 1), name(i + 1, j, 1), name(i + 1, j + 1, 1), name(i, j + 1, 1));
    quad(name(i, j, 0), name(i, j + 1, 0), name(i + 1, j + 1, 0), name(i + 1, j, 0));
    const std::array<std::array<int, 2>, 4> ring = {
        {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
    const std::array<std::array<int, 2>, 4> beyond = {
        {{i, j - 1}, {i + 1, j}, {i, j + 1}, {i - 1, j}}};
    for (std::size_t k = 0; k < 4; ++k) {
      if (has(beyond[k][0], beyond[k][1])) continue;
      const auto &a = ring[k], &b = ring[(k + 1) % 4];
      quad(name(a[0], a[1], 0), name(b[0], b[1], 0), name(b[0], b[1], 1), name(a[0], a[1], 1));
    }
  }
  return mesh;
}

inline TriangleMesh Ball(double radius, int rings) {
  TriangleMesh mesh;
  const int sectors = 2 * rings;
  mesh.vertices.push_back({0, 0, radius});
  for (int r = 1; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const double theta = std::numbers::pi * r / rings, phi = 2 * std::numbers::pi * s / sectors;
      mesh.vertices.push_back(radius * Vec3d{std::sin(theta) * std::cos(phi),
                                             std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  }
  mesh.vertices.push_back({0, 0, -radius});
  const auto at = [&](int r, int s) {
    return static_cast<std::uint32_t>(1 + (r - 1) * sectors + s % sectors);
  };
  const auto south = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (int s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    mesh.triangles.push_back({at(rings - 1, s), south, at(rings - 1, s + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  }
  return mesh;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_SHAPES_BLOCK_LETTER_H_
