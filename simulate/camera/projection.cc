// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/projection.h"

#include <algorithm>
#include <cmath>

namespace flocklift {
namespace {

// Distortion of a normalised point, and its derivatives. `regular`: the map keeps orientation here
// and the denominator of the radial factor has not changed its sign.
struct Distorted {
  Vec2d point;
  double dxdx, dxdy, dydx, dydy;
  bool regular;

  double Determinant() const { return dxdx * dydy - dxdy * dydx; }
};

Distorted Distort(const std::array<double, 12>& d, const Vec2d& n) {
  const double x = n.x, y = n.y, r2 = x * x + y * y;
  const double above = 1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  const double below = 1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7]));
  const double above_slope = d[0] + r2 * (2 * d[1] + r2 * 3 * d[4]);  // d / d r2
  const double below_slope = d[5] + r2 * (2 * d[6] + r2 * 3 * d[7]);
  const double radial = above / below;
  const double slope = (above_slope - radial * below_slope) / below;
  const double prism_x = d[8] + 2 * d[9] * r2, prism_y = d[10] + 2 * d[11] * r2;
  const double mixed = 2 * (x * y * slope + d[2] * x + d[3] * y);

  Distorted result;
  result.point = ProjectNormalized<double>({1, 1, 0, 0, d}, n);
  result.dxdx = radial + 2 * x * x * slope + 2 * d[2] * y + 6 * d[3] * x + 2 * x * prism_x;
  result.dxdy = mixed + 2 * y * prism_x;
  result.dydx = mixed + 2 * x * prism_y;
  result.dydy = radial + 2 * y * y * slope + 6 * d[2] * y + 2 * d[3] * x + 2 * y * prism_y;
  result.regular = below > 0 && result.Determinant() > 0;  // false for NaN
  return result;
}

double Distance(const Vec2d& a, const Vec2d& b) { return std::hypot(a.x - b.x, a.y - b.y); }

// Newton's method from `start` to the point that is distorted onto `target`. It goes on while it
// gets nearer; nothing unless it ends within rounding of the target, on regular ground all along.
std::optional<Vec2d> Newton(const std::array<double, 12>& d, const Vec2d& start,
                            const Vec2d& target) {
  constexpr int kMaxSteps = 50;
  const double tolerance = 1e-13 * (1 + std::hypot(target.x, target.y));
  Vec2d best = start;
  Distorted at = Distort(d, best);
  double error = Distance(at.point, target);
  for (int step = 0; step < kMaxSteps && at.regular && error > 0; ++step) {
    const double ex = at.point.x - target.x, ey = at.point.y - target.y;
    const double determinant = at.Determinant();
    const Vec2d next{best.x - (at.dydy * ex - at.dxdy * ey) / determinant,
                     best.y - (at.dxdx * ey - at.dydx * ex) / determinant};
    const Distorted there = Distort(d, next);
    const double next_error = Distance(there.point, target);
    if (!(next_error < error)) break;
    best = next;
    at = there;
    error = next_error;
  }
  if (!at.regular || !(error <= tolerance)) return std::nullopt;
  return best;
}

// Is the straight way from the optical axis to `n` free of folds?
bool ConnectsToAxis(const std::array<double, 12>& d, const Vec2d& n) {
  constexpr int kSamples = 24;
  for (int k = 0; k <= kSamples; ++k) {
    const double share = static_cast<double>(k) / kSamples;
    if (!Distort(d, {share * n.x, share * n.y}).regular) return false;
  }
  return true;
}

// Follows the solution from the optical axis while the target moves out to its place.
std::optional<Vec2d> Continue(const std::array<double, 12>& d, const Vec2d& target) {
  constexpr double kSmallestStep = 1e-4, kFarthestMove = 0.05;
  Vec2d n{};
  double reached = 0, step = 1.0 / 32;
  while (reached < 1) {
    const double next = std::min(1.0, reached + step);
    const auto solution = Newton(d, n, {next * target.x, next * target.y});
    const double move = solution ? Distance(*solution, n) : 0;
    if (solution && move <= kFarthestMove * (1 + std::hypot(n.x, n.y))) {
      n = *solution;
      reached = next;
      step *= 1.5;
    } else if ((step *= 0.5) < kSmallestStep) {
      return std::nullopt;
    }
  }
  return n;
}

}  // namespace

std::optional<Vec2d> RayThroughPixel(const Intrinsics& k, const Vec2d& pixel) {
  const Vec2d target{(pixel.x - k.cx) / k.fx, (pixel.y - k.cy) / k.fy};
  if (!std::isfinite(target.x) || !std::isfinite(target.y)) return std::nullopt;
  const auto& d = k.distortion;
  if (std::all_of(d.begin(), d.end(), [](double c) { return c == 0; })) return target;
  const auto ray = Newton(d, target, target);
  if (ray && ConnectsToAxis(d, *ray)) return ray;
  return Continue(d, target);
}

std::optional<Vec2d> ProjectVisible(const Camera& camera, const Vec3d& point_in_cam) {
  if (!(point_in_cam.z > 0)) return std::nullopt;
  const Vec2d n{point_in_cam.x / point_in_cam.z, point_in_cam.y / point_in_cam.z};
  const Vec2d pixel = ProjectNormalized(camera.intrinsics, n);
  if (!camera.Sees(pixel)) return std::nullopt;  // false for NaN, too
  if (!ConnectsToAxis(camera.intrinsics.distortion, n)) return std::nullopt;
  return pixel;
}

}  // namespace flocklift
