// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/grid_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kMostNodes = 2147483647.0;  // so that 32 bits number them

// A coordinate in spacings from the first node, kept on the grid.
double OnGrid(double coordinate, double low, double spacing, int nodes) {
  return std::clamp((coordinate - low) / spacing, 0.0, nodes - 1.0);
}

// Nodes and weights of the quadratic B-spline along one axis, with derivatives per spacing. At the
// rim the missing node repeats the last one.
struct Spline {
  std::array<int, 3> node;
  std::array<double, 3> weight, slope;
  static constexpr std::array<double, 3> kBend = {1, -2, 1};

  Spline(double coordinate, double low, double spacing, int nodes) {
    const double x = OnGrid(coordinate, low, spacing, nodes);
    const int centre = std::min(static_cast<int>(x + 0.5), nodes - 1);
    const double u = x - centre;  // -1/2 .. 1/2
    for (int k = 0; k < 3; ++k) node[k] = std::clamp(centre + k - 1, 0, nodes - 1);
    weight = {0.5 * (0.5 - u) * (0.5 - u), 0.75 - u * u, 0.5 * (0.5 + u) * (0.5 + u)};
    slope = {u - 0.5, -2 * u, u + 0.5};
  }
};

}  // namespace

std::size_t Grid::Nearest(const Vec3d& p) const {
  return Index(static_cast<int>(OnGrid(p.x, low.x, spacing, nx) + 0.5),
               static_cast<int>(OnGrid(p.y, low.y, spacing, ny) + 0.5),
               static_cast<int>(OnGrid(p.z, low.z, spacing, nz) + 0.5));
}

Grid GridOver(const Vec3d& low, const Vec3d& high, double spacing) {
  Check(spacing > 0 && std::isfinite(spacing), "a grid's spacing must be positive");
  Check(low.x <= high.x && low.y <= high.y && low.z <= high.z, "a grid's box is empty");
  const auto nodes = [spacing](double from, double to) {
    // A hair of tolerance, so that 0.3 / 0.1 is three cells.
    return std::ceil((to - from) / spacing - 1e-9) + 1;
  };
  const double x = nodes(low.x, high.x), y = nodes(low.y, high.y), z = nodes(low.z, high.z);
  Check(x * y * z <= kMostNodes, "a grid of that spacing would need more than 2^31 nodes");
  return {low, spacing, static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
}

GridCell CellOf(const Grid& g, const Vec3d& p) {
  const double x = OnGrid(p.x, g.low.x, g.spacing, g.nx);
  const double y = OnGrid(p.y, g.low.y, g.spacing, g.ny);
  const double z = OnGrid(p.z, g.low.z, g.spacing, g.nz);
  const int i = std::min(static_cast<int>(x), std::max(g.nx - 2, 0));
  const int j = std::min(static_cast<int>(y), std::max(g.ny - 2, 0));
  const int k = std::min(static_cast<int>(z), std::max(g.nz - 2, 0));
  return {g.Index(i, j, k),
          g.nx > 1 ? std::size_t{1} : 0,
          g.ny > 1 ? static_cast<std::size_t>(g.nx) : 0,
          g.nz > 1 ? static_cast<std::size_t>(g.nx) * g.ny : 0,
          {x - i, y - j, z - k}};
}

double ScalarField::Sample(const Vec3d& p) const { return SampleLinear(p).value; }

FieldSample ScalarField::SampleLinear(const Vec3d& p) const {
  const GridCell cell = CellOf(grid, p);
  const double u = cell.u.x, v = cell.u.y, w = cell.u.z;
  // One edge along x at a time: what it has at u, and its slope.
  const auto edge = [&](std::size_t index, double* slope) {
    const double a = values[index], b = values[index + cell.step_x];
    *slope = b - a;
    return a + u * (b - a);
  };
  double s00, s10, s01, s11;
  const double e00 = edge(cell.index, &s00);
  const double e10 = edge(cell.index + cell.step_y, &s10);
  const double e01 = edge(cell.index + cell.step_z, &s01);
  const double e11 = edge(cell.index + cell.step_y + cell.step_z, &s11);
  const double f0 = e00 + v * (e10 - e00), f1 = e01 + v * (e11 - e01);
  FieldSample sample;
  sample.value = f0 + w * (f1 - f0);
  sample.gradient = Vec3d{(1 - w) * ((1 - v) * s00 + v * s10) + w * ((1 - v) * s01 + v * s11),
                          (1 - w) * (e10 - e00) + w * (e11 - e01), f1 - f0} /
                    grid.spacing;
  return sample;
}

SmoothSample ScalarField::SampleSmooth(const Vec3d& p) const {
  const Spline x(p.x, grid.low.x, grid.spacing, grid.nx);
  const Spline y(p.y, grid.low.y, grid.spacing, grid.ny);
  const Spline z(p.z, grid.low.z, grid.spacing, grid.nz);
  SmoothSample s;
  for (int c = 0; c < 3; ++c) {
    for (int b = 0; b < 3; ++b) {
      const float* const row = &values[grid.Index(0, y.node[b], z.node[c])];
      double value = 0, slope = 0, bend = 0;  // along x
      for (int a = 0; a < 3; ++a) {
        const double node = row[x.node[a]];
        value += x.weight[a] * node;
        slope += x.slope[a] * node;
        bend += Spline::kBend[a] * node;
      }
      s.value += y.weight[b] * z.weight[c] * value;
      s.gradient.x += y.weight[b] * z.weight[c] * slope;
      s.gradient.y += y.slope[b] * z.weight[c] * value;
      s.gradient.z += y.weight[b] * z.slope[c] * value;
      s.xx += y.weight[b] * z.weight[c] * bend;
      s.yy += Spline::kBend[b] * z.weight[c] * value;
      s.zz += y.weight[b] * Spline::kBend[c] * value;
      s.xy += y.slope[b] * z.weight[c] * slope;
      s.xz += y.weight[b] * z.slope[c] * slope;
      s.yz += y.slope[b] * z.slope[c] * value;
    }
  }
  const double per_metre = 1 / grid.spacing, squared = per_metre * per_metre;
  s.gradient *= per_metre;
  for (double* second : {&s.xx, &s.yy, &s.zz, &s.xy, &s.xz, &s.yz}) *second *= squared;
  return s;
}

}  // namespace flocklift
