// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/target_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <list>
#include <numeric>
#include <optional>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr double kCellsPerMargin = 3;
constexpr double kMostCells = 3e7;
constexpr double kRoundOff = 1e-10;  // relative

constexpr double kFar = std::numeric_limits<double>::infinity();

Vec3d Least(const Vec3d& a, const Vec3d& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vec3d Most(const Vec3d& a, const Vec3d& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

bool Holds(const BoundingSphere& sphere, const Vec3d& p) {
  return Norm(p - sphere.centre) <= sphere.radius * (1 + kRoundOff) + kRoundOff * 1e-3;
}

// The sphere with up to four points on it: its centre is x0 + sum_k s_k (x_k - x0), where
// 2 sum_l s_l (x_k - x0).(x_l - x0) = |x_k - x0|^2.
BoundingSphere Through(const std::vector<Vec3d>& rim) {
  if (rim.empty()) return {{}, -1};
  const std::size_t n = rim.size() - 1;
  double m[3][4] = {};
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t l = 0; l < n; ++l) m[k][l] = 2 * Dot(rim[k + 1] - rim[0], rim[l + 1] - rim[0]);
    m[k][3] = SquaredNorm(rim[k + 1] - rim[0]);
  }
  for (std::size_t k = 0; k < n; ++k) {  // Gauss with pivots; a dependent point adds nothing
    std::size_t pivot = k;
    for (std::size_t r = k; r < n; ++r) {
      if (std::abs(m[r][k]) > std::abs(m[pivot][k])) pivot = r;
    }
    std::swap_ranges(m[k], m[k] + 4, m[pivot]);
    if (m[k][k] == 0) continue;
    for (std::size_t r = 0; r < n; ++r) {
      if (r == k) continue;
      const double factor = m[r][k] / m[k][k];
      for (std::size_t c = k; c < 4; ++c) m[r][c] -= factor * m[k][c];
    }
  }
  Vec3d centre = rim[0];
  for (std::size_t k = 0; k < n; ++k) {
    if (m[k][k] != 0) centre += m[k][3] / m[k][k] * (rim[k + 1] - rim[0]);
  }
  return {centre, Norm(centre - rim[0])};
}

// The smallest sphere of the points before `end` with those of `rim` on it.
BoundingSphere MoveToFront(std::list<Vec3d>* points, std::list<Vec3d>::iterator end,
                           std::vector<Vec3d>* rim) {
  BoundingSphere sphere = Through(*rim);
  if (rim->size() == 4) return sphere;
  for (auto p = points->begin(); p != end;) {
    const auto here = p++;
    if (Holds(sphere, *here)) continue;
    rim->push_back(*here);
    sphere = MoveToFront(points, here, rim);
    rim->pop_back();
    points->splice(points->begin(), *points, here);
  }
  return sphere;
}

// Eigenvectors of a symmetric matrix by Jacobi's rotations, as columns.
std::array<Vec3d, 3> PrincipalAxes(std::array<std::array<double, 3>, 3> a) {
  std::array<std::array<double, 3>, 3> v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < 30; ++sweep) {
    for (std::size_t p = 0; p < 2; ++p) {
      for (std::size_t q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0) continue;
        const double angle = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]);
        const double c = std::cos(angle), s = std::sin(angle);
        for (std::size_t k = 0; k < 3; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const double x = a[p][k], y = a[q][k], vx = v[k][p], vy = v[k][q];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
          v[k][p] = c * vx - s * vy;
          v[k][q] = s * vx + c * vy;
        }
      }
    }
  }
  return {{{v[0][0], v[1][0], v[2][0]}, {v[0][1], v[1][1], v[2][1]}, {v[0][2], v[1][2], v[2][2]}}};
}

}  // namespace

BoundingSphere SmallestSphere(std::span<const Vec3d> points) {
  if (points.empty()) return {};
  std::vector<Vec3d> shuffled(points.begin(), points.end());
  Rng rng(1);
  for (std::size_t k = shuffled.size(); k > 1; --k) {
    std::swap(shuffled[k - 1], shuffled[rng.Below(static_cast<std::uint32_t>(k))]);
  }
  std::list<Vec3d> list(shuffled.begin(), shuffled.end());
  std::vector<Vec3d> rim;
  return MoveToFront(&list, list.end(), &rim);
}

TargetRegion::TargetRegion(RegionKind kind, std::span<const Tetra> target, double margin)
    : kind_(kind) {
  Check(!target.empty(), "a target needs tetrahedra");
  Check(kind != RegionKind::kShape || margin > 0, "the margin about a shape must be positive");
  std::vector<Vec3d> corners;
  for (const Tetra& t : target) corners.insert(corners.end(), t.begin(), t.end());
  sphere_ = SmallestSphere(corners);
  if (kind == RegionKind::kBox) FitBox(corners, margin);
  if (kind == RegionKind::kShape) FillCells(target, margin);
}

void TargetRegion::FitBox(std::span<const Vec3d> corners, double margin) {
  Vec3d mean;
  for (const Vec3d& p : corners) mean += p / static_cast<double>(corners.size());
  std::array<std::array<double, 3>, 3> spread{};
  for (const Vec3d& p : corners) {
    const std::array<double, 3> d{p.x - mean.x, p.y - mean.y, p.z - mean.z};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) spread[r][c] += d[r] * d[c];
    }
  }
  axes_ = PrincipalAxes(spread);
  low_ = {kFar, kFar, kFar};
  high_ = -low_;
  for (const Vec3d& p : corners) {
    const Vec3d along{Dot(axes_[0], p), Dot(axes_[1], p), Dot(axes_[2], p)};
    low_ = Least(low_, along);
    high_ = Most(high_, along);
  }
  low_ -= Vec3d{margin, margin, margin};
  high_ += Vec3d{margin, margin, margin};
  const Vec3d middle = 0.5 * (low_ + high_);
  sphere_ = {middle.x * axes_[0] + middle.y * axes_[1] + middle.z * axes_[2],
             0.5 * Norm(high_ - low_)};
}

// The balls about the tetrahedra, grown by the margin, hold the grown shape and little more.
void TargetRegion::FillCells(std::span<const Tetra> target, double margin) {
  low_ = {kFar, kFar, kFar};
  high_ = -low_;
  for (const Tetra& t : target) {
    const double reach = BoundingRadius(t) + margin;
    low_ = Least(low_, Centroid(t) - Vec3d{reach, reach, reach});
    high_ = Most(high_, Centroid(t) + Vec3d{reach, reach, reach});
  }
  const Vec3d size = high_ - low_;
  const double cell =
      std::max(margin / kCellsPerMargin, std::cbrt(size.x * size.y * size.z / kMostCells));
  const int nx = static_cast<int>(size.x / cell) + 1, ny = static_cast<int>(size.y / cell) + 1,
            nz = static_cast<int>(size.z / cell) + 1;
  cells_.low_x = static_cast<float>(low_.x);
  cells_.low_y = static_cast<float>(low_.y);
  cells_.low_z = static_cast<float>(low_.z);
  cells_.per_cell = static_cast<float>(1 / cell);
  cells_.nx = nx;
  cells_.ny = ny;
  cells_.nz = nz;
  bits_.assign((static_cast<std::size_t>(nx) * ny * nz + 7) / 8, 0);
  for (const Tetra& t : target) {
    const double reach = BoundingRadius(t) + margin;
    const Vec3d centre = Centroid(t) - low_;
    const auto range = [&](double x, int n) {
      return std::pair(std::max(0, static_cast<int>((x - reach) / cell)),
                       std::min(n - 1, static_cast<int>((x + reach) / cell)));
    };
    const auto [i0, i1] = range(centre.x, nx);
    const auto [j0, j1] = range(centre.y, ny);
    const auto [k0, k1] = range(centre.z, nz);
    for (int k = k0; k <= k1; ++k) {
      for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i) {
          const Vec3d middle = cell * Vec3d{i + 0.5, j + 0.5, k + 0.5};
          if (SquaredNorm(middle - centre) > reach * reach) continue;
          const std::size_t at = (static_cast<std::size_t>(k) * ny + j) * nx + i;
          bits_[at / 8] |= static_cast<std::uint8_t>(1U << at % 8);
        }
      }
    }
  }
  sphere_ = {0.5 * (low_ + high_), 0.5 * Norm(size)};
}

bool TargetRegion::Contains(const Vec3d& p) const {
  if (SquaredNorm(p - sphere_.centre) > sphere_.radius * sphere_.radius) return false;
  if (kind_ == RegionKind::kSphere) return true;
  if (kind_ == RegionKind::kBox) {
    const Vec3d along{Dot(axes_[0], p), Dot(axes_[1], p), Dot(axes_[2], p)};
    return along == Most(low_, Least(high_, along));
  }
  const MorphRegion& c = cells_;
  const float u = (static_cast<float>(p.x) - c.low_x) * c.per_cell,
              v = (static_cast<float>(p.y) - c.low_y) * c.per_cell,
              w = (static_cast<float>(p.z) - c.low_z) * c.per_cell;
  if (!(u >= 0 && v >= 0 && w >= 0)) return false;
  const int i = static_cast<int>(u), j = static_cast<int>(v), k = static_cast<int>(w);
  if (i >= c.nx || j >= c.ny || k >= c.nz) return false;
  const std::size_t at = (static_cast<std::size_t>(k) * c.ny + j) * c.nx + i;
  return (bits_[at / 8] >> at % 8 & 1) != 0;
}

MorphRegion TargetRegion::View() const {
  MorphRegion view = cells_;
  view.cells = kind_ == RegionKind::kShape ? bits_.data() : nullptr;
  view.sphere_x = static_cast<float>(sphere_.centre.x);
  view.sphere_y = static_cast<float>(sphere_.centre.y);
  view.sphere_z = static_cast<float>(sphere_.centre.z);
  view.squared_reach = static_cast<float>(sphere_.radius * sphere_.radius * (1 + 1e-5));
  return view;
}

}  // namespace flocklift
