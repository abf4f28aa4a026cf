// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/body.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/camera/projection.h"

namespace flocklift {
namespace {

// Outline of one wing in units of half the wingspan: x forward, y outward.
constexpr Vec2d kRootFront{0.16, 0.06}, kRootBack{-0.20, 0.06};
constexpr Vec2d kWristFront{0.24, 0.45}, kWristBack{-0.15, 0.45};
constexpr Vec2d kHandFront{0.12, 0.85}, kTip{-0.06, 1.0}, kHandBack{-0.17, 0.80};
constexpr double kRootThickness = 0.06, kTipThickness = 0.01;  // linear in between

constexpr double kStroke = 0.8;  // amplitude of the inner wing [rad]
constexpr double kHang = 0.6;    // of the outer wing on the upstroke [rad]
constexpr double kSweep = 0.5;   // of the outer wing on the upstroke [rad]

// Semi-axes of the spindle and the tail, in units of body_length.
constexpr double kBodyCenter = 0.08, kBodyHalfLength = 0.42, kBodyHalfWidth = 0.14;
constexpr double kTailRoot = -0.22, kTailEnd = -0.5;
constexpr double kTailRootHalfWidth = 0.06, kTailEndHalfWidth = 0.14, kTailThickness = 0.02;

// Angles of both wings at one moment.
struct WingPose {
  double raise = 0, hang = 0, sweep = 0;  // [rad]

  WingPose(const Animal& animal, double time) {
    if (!(animal.wingbeat_hz > 0)) return;
    const double phase = 2 * std::numbers::pi * animal.wingbeat_hz * time + animal.wingbeat_phase;
    const double upstroke = 0.5 * (1 + std::cos(phase));
    raise = kStroke * std::sin(phase);
    hang = kHang * upstroke * upstroke;
    sweep = kSweep * upstroke * upstroke;
  }
};

// Two panels of a wing; side is +1 for the left, -1 for the right.
void AddWing(const WingPose& pose, double half_span, double side, std::vector<BodyPart>* parts) {
  const double cos_raise = std::cos(pose.raise), sin_raise = std::sin(pose.raise);
  const double cos_outer = std::cos(pose.raise - pose.hang);
  const double sin_outer = std::sin(pose.raise - pose.hang);
  const double cos_sweep = std::cos(pose.sweep), sin_sweep = std::sin(pose.sweep);
  const double arm = kWristFront.y - kRootFront.y;

  const auto half_thickness = [](const Vec2d& p) {
    return 0.5 * (kRootThickness + (kTipThickness - kRootThickness) * p.y);
  };
  const auto inner = [&](const Vec2d& p, double up) {
    const double out = p.y - kRootFront.y;
    return half_span * Vec3d{p.x, side * (kRootFront.y + out * cos_raise - up * sin_raise),
                             out * sin_raise + up * cos_raise};
  };
  const auto outer = [&](const Vec2d& p, double up) {  // swept about the wrist, then raised
    const double dx = p.x - kWristFront.x, dy = p.y - kWristFront.y;
    const double forward = kWristFront.x + dx * cos_sweep - dy * sin_sweep;
    const double out = dx * sin_sweep + dy * cos_sweep;
    return half_span *
           Vec3d{forward,
                 side * (kRootFront.y + arm * cos_raise + out * cos_outer - up * sin_outer),
                 arm * sin_raise + out * sin_outer + up * cos_outer};
  };
  BodyPart& arm_panel = parts->emplace_back();
  for (const Vec2d& p : {kRootFront, kWristFront, kWristBack, kRootBack}) {
    arm_panel.Add(inner(p, half_thickness(p)));
    arm_panel.Add(inner(p, -half_thickness(p)));
  }
  BodyPart& hand_panel = parts->emplace_back();
  for (const Vec2d& p : {kWristFront, kHandFront, kTip, kHandBack, kWristBack}) {
    hand_panel.Add(outer(p, half_thickness(p)));
    hand_panel.Add(outer(p, -half_thickness(p)));
  }
}

// The rim of the spindle as it appears from `viewer`: with the ellipsoid mapped onto the unit
// sphere, the great circle across the line of sight.
BodyPart SpindleRim(double length, const Vec3d& viewer) {
  const Vec3d semi_axes = length * Vec3d{kBodyHalfLength, kBodyHalfWidth, kBodyHalfWidth};
  const Vec3d center{length * kBodyCenter, 0, 0};
  const Vec3d to_viewer = viewer - center;
  Vec3d sight =
      Normalized({to_viewer.x / semi_axes.x, to_viewer.y / semi_axes.y, to_viewer.z / semi_axes.z});
  if (sight == Vec3d{}) sight = {0, 0, 1};
  const Vec3d helper = std::abs(sight.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d a = Normalized(Cross(sight, helper)), b = Cross(sight, a);
  static const auto kCircle = [] {
    std::array<Vec2d, ConvexPolygon::kMaxCorners> circle;
    for (std::size_t k = 0; k < circle.size(); ++k) {
      const double angle =
          2 * std::numbers::pi * static_cast<double>(k) / ConvexPolygon::kMaxCorners;
      circle[k] = {std::cos(angle), std::sin(angle)};
    }
    return circle;
  }();
  BodyPart rim;
  for (const Vec2d& on_circle : kCircle) {
    const Vec3d p = on_circle.x * a + on_circle.y * b;
    rim.Add(center + Vec3d{p.x * semi_axes.x, p.y * semi_axes.y, p.z * semi_axes.z});
  }
  return rim;
}

BodyPart Tail(double length) {
  BodyPart tail;
  for (const double z : {-0.5 * kTailThickness, 0.5 * kTailThickness}) {
    for (const double side : {-1.0, 1.0}) {
      tail.Add(length * Vec3d{kTailRoot, side * kTailRootHalfWidth, z});
      tail.Add(length * Vec3d{kTailEnd, side * kTailEndHalfWidth, z});
    }
  }
  return tail;
}

// Does the ray through the image of `normalized` lead back to it?
bool IsFolded(const Intrinsics& intrinsics, const Vec2d& normalized, const Vec2d& pixel) {
  if (std::all_of(intrinsics.distortion.begin(), intrinsics.distortion.end(),
                  [](double d) { return d == 0; })) {
    return false;
  }
  const auto ray = RayThroughPixel(intrinsics, pixel);
  return !ray || std::hypot(ray->x - normalized.x, ray->y - normalized.y) > 1e-6;
}

}  // namespace

std::vector<BodyPart> BodyParts(const Animal& animal, double time, const Vec3d& viewer_in_body) {
  std::vector<BodyPart> parts;
  parts.reserve(6);
  const WingPose pose(animal, time);
  parts.push_back(SpindleRim(animal.body_length, viewer_in_body));
  parts.push_back(Tail(animal.body_length));
  AddWing(pose, 0.5 * animal.wingspan, 1, &parts);
  AddWing(pose, 0.5 * animal.wingspan, -1, &parts);
  return parts;
}

std::optional<ProjectedBody> ProjectBody(const FlyingAnimal& flying, double time,
                                         const Camera& camera, const Rigid3d& cam_from_world) {
  const Vec3d position_in_cam = cam_from_world * flying.position;
  const double reach = 0.6 * std::max(flying.animal.wingspan, flying.animal.body_length);
  if (!(position_in_cam.z > reach)) return std::nullopt;

  const Intrinsics& intrinsics = camera.intrinsics;
  ProjectedBody body;
  body.depth = position_in_cam.z;
  body.center = Project(intrinsics, position_in_cam);
  const double margin =
      4 * reach * std::max(intrinsics.fx, intrinsics.fy) / (position_in_cam.z - reach);
  if (!(body.center.x > -margin && body.center.x < camera.width + margin &&
        body.center.y > -margin && body.center.y < camera.height + margin)) {
    return std::nullopt;
  }
  const Vec2d normalized{position_in_cam.x / position_in_cam.z,
                         position_in_cam.y / position_in_cam.z};
  if (IsFolded(intrinsics, normalized, body.center)) return std::nullopt;

  const Vec3d viewer_in_world = cam_from_world.Inverse().translation;
  const Vec3d viewer_in_body =
      flying.world_from_body.Inverse() * (viewer_in_world - flying.position);
  std::vector<ConvexPolygon> polygons;
  for (const BodyPart& part : BodyParts(flying.animal, time, viewer_in_body)) {
    std::array<Vec2d, ConvexPolygon::kMaxCorners> points;
    for (std::size_t k = 0; k < static_cast<std::size_t>(part.corners); ++k) {
      const Vec3d offset_in_world = flying.world_from_body * part.corner[k];
      points[k] = Project(intrinsics, position_in_cam + cam_from_world.rotation * offset_in_world);
    }
    polygons.push_back(HullOf({points.data(), static_cast<std::size_t>(part.corners)}));
  }
  body.silhouette = UnionOf(polygons);
  body.moments = MomentsOf(body.silhouette);
  if (!(body.moments.area > 0)) return std::nullopt;
  const Vec2d found = body.moments.centroid;
  body.silhouette.Shift({body.center.x - found.x, body.center.y - found.y});
  body.moments.centroid = body.center;
  return body;
}

}  // namespace flocklift
