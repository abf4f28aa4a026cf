// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/body_centred_lattice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

// The lattice is set off by odd shares of a cell, so that surfaces drawn on round numbers do not
// run along lattice planes.
constexpr Vec3d kOffset{0.3819660, 0.2360680, 0.4142136};

constexpr double kMostPoints = 2e8;

// Calls fn(z, winding) for the lattice's lines along z that the triangle's projection contains.
// Edges are judged from their smaller vertex on, so that neighbours agree to the last bit.
template <typename Function>
void ForEachLineThrough(const TriangleMesh& surface, std::size_t triangle,
                        const BodyCentredLattice& lattice, int kind, const Function& fn) {
  const auto& corners = surface.triangles[triangle];
  const std::array<Vec3d, 3> p{surface.vertices[corners[0]], surface.vertices[corners[1]],
                               surface.vertices[corners[2]]};
  const Vec3d normal = Cross(p[1] - p[0], p[2] - p[0]);
  if (normal.z == 0) return;
  const Vec3d start = lattice.LineStart(kind, 0, 0);
  const auto range = [&](double a, double b, double c, double from, int count) {
    const double low = std::min({a, b, c}), high = std::max({a, b, c});
    return std::pair(std::max(0, static_cast<int>(std::floor((low - from) / lattice.cell()))),
                     std::min(count - 1, static_cast<int>((high - from) / lattice.cell()) + 1));
  };
  const auto [i0, i1] = range(p[0].x, p[1].x, p[2].x, start.x, lattice.cells(0) + 1 - kind);
  const auto [j0, j1] = range(p[0].y, p[1].y, p[2].y, start.y, lattice.cells(1) + 1 - kind);
  const double lowest = std::min({p[0].z, p[1].z, p[2].z});
  const double highest = std::max({p[0].z, p[1].z, p[2].z});
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const Vec3d q = lattice.LineStart(kind, i, j);
      int left = 0;
      for (std::size_t e = 0; e < 3; ++e) {
        std::size_t a = e, b = (e + 1) % 3;
        const bool swapped = corners[a] > corners[b];
        if (swapped) std::swap(a, b);
        const double side = (p[b].x - p[a].x) * (q.y - p[a].y) - (p[b].y - p[a].y) * (q.x - p[a].x);
        left += (side >= 0) != swapped ? 1 : 0;
      }
      if (left != 0 && left != 3) continue;
      const double z = p[0].z - (normal.x * (q.x - p[0].x) + normal.y * (q.y - p[0].y)) / normal.z;
      fn(i, j, std::clamp(z, lowest, highest), left == 3 ? -1 : 1);
    }
  }
}

}  // namespace

BodyCentredLattice::BodyCentredLattice(const TriangleMesh& surface, double cell) : cell_(cell) {
  Vec3d low = surface.Corner(0, 0), high = low;
  for (const auto& triangle : surface.triangles) {
    for (const std::uint32_t corner : triangle) {
      const Vec3d& p = surface.vertices[corner];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  low_ = low - cell * (Vec3d{1, 1, 1} + kOffset);
  const Vec3d cells = (high - low_) / cell + Vec3d{2, 2, 2};
  Check(cells.x * cells.y * cells.z < kMostPoints, "the lattice is too fine for the surface");
  n_ = {static_cast<int>(cells.x), static_cast<int>(cells.y), static_cast<int>(cells.z)};
  corners_ = static_cast<std::size_t>(n_[0] + 1) * (n_[1] + 1) * (n_[2] + 1);
  points_ = corners_ + static_cast<std::size_t>(n_[0]) * n_[1] * n_[2];
}

std::vector<signed char> SignsOn(const BodyCentredLattice& lattice, const TriangleMesh& surface) {
  std::vector<signed char> signs(lattice.size(), -1);
  for (int kind = 0; kind < 2; ++kind) {
    const int nx = lattice.cells(0) + 1 - kind, ny = lattice.cells(1) + 1 - kind;
    const int nz = lattice.cells(2) + 1 - kind;
    std::vector<std::vector<std::pair<double, int>>> crossings(static_cast<std::size_t>(nx) * ny);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      ForEachLineThrough(surface, t, lattice, kind, [&](int i, int j, double z, int winding) {
        crossings[static_cast<std::size_t>(j) * nx + i].emplace_back(z, winding);
      });
    }
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        auto& line = crossings[static_cast<std::size_t>(j) * nx + i];
        std::sort(line.begin(), line.end());
        const double z0 = lattice.LineStart(kind, i, j).z;
        int winding = 0;  // counted -1 where the line leaves by an upward face
        std::size_t next = 0;
        for (int k = 0; k < nz; ++k) {
          const double z = z0 + k * lattice.cell();
          for (; next < line.size() && line[next].first < z; ++next) winding += line[next].second;
          if (winding > 0) signs[lattice.Point(kind, i, j, k)] = 1;
        }
      }
    }
  }
  return signs;
}

}  // namespace flocklift
