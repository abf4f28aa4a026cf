// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/triangulation.h"

#include <algorithm>
#include <cmath>

namespace flocklift {

std::optional<Vec2d> RayAt(const Segment& segment, double time) {
  constexpr double kLongestGap = 0.5, kSlack = 1e-9;  // [s]
  const auto& s = segment.sightings;
  if (s.empty() || time < s.front().time - kSlack || time > s.back().time + kSlack) {
    return std::nullopt;
  }
  const auto after = std::partition_point(
      s.begin(), s.end(), [&](const Sighting& q) { return q.time < time - kSlack; });
  if (after == s.begin()) return after->ray;
  if (after == s.end()) return s.back().ray;
  const Sighting& left = *(after - 1);
  if (after->time - left.time > kLongestGap) return std::nullopt;
  const double share = std::clamp((time - left.time) / (after->time - left.time), 0.0, 1.0);
  return Vec2d{left.ray.x + share * (after->ray.x - left.ray.x),
               left.ray.y + share * (after->ray.y - left.ray.y)};
}

std::optional<double> EpipolarDistance(const Vec2d& ray, const View& view) {
  const Vec3d direction = view.view_from_ref.rotation * Vec3d{ray.x, ray.y, 1};
  const Vec3d plane = Cross(view.view_from_ref.translation, direction);
  const double slope = std::hypot(plane.x, plane.y);
  constexpr double kLeast = 1e-6;
  if (slope < kLeast * Norm(view.view_from_ref.translation)) return std::nullopt;
  return Dot(plane, Vec3d{view.ray.x, view.ray.y, 1}) / slope;
}

std::optional<double> TriangulatedDepth(const Vec2d& ray, const View& view) {
  // Nearest points z a on the first ray and o + s b on the second, all in the second camera's axes.
  const Vec3d a = view.view_from_ref.rotation * Vec3d{ray.x, ray.y, 1};
  const Vec3d b{view.ray.x, view.ray.y, 1};
  const Vec3d& o = view.view_from_ref.translation;  // the first camera; the second one is at 0
  const double aa = Dot(a, a), ab = Dot(a, b), bb = Dot(b, b);
  const double determinant = aa * bb - ab * ab;
  constexpr double kParallel = 1e-8;
  if (determinant < kParallel * aa * bb) return std::nullopt;
  const double z = (ab * Dot(b, o) - bb * Dot(a, o)) / determinant;
  const double s = (aa * Dot(b, o) - ab * Dot(a, o)) / determinant;
  if (!(z > 0) || !(s > 0)) return std::nullopt;
  return z;
}

}  // namespace flocklift
