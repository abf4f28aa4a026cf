// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solid that stands for a bird, and its image: a spindle of a body, a fanned tail and two
// tapering wings of some thickness, each jointed at root and wrist. Body frame: x forward, y left,
// z up.
//
// With s = wingspan / 2 and wingbeat phase p = 2 pi f t + p0, the inner wing (root at 0.06 s,
// wrist at 0.45 s) is raised by 0.8 sin p. On the upstroke, u = (1 + cos p) / 2 -> 1, the outer
// wing (wrist to tip at s) hangs by 0.6 u^2 and sweeps back by 0.5 u^2 [rad]. In the middle of the
// downstroke, u = 0, the wings are level and stretched: tip to tip they measure the wingspan. An
// animal with wingbeat_hz = 0 glides in that pose.
//
// Where the animal is: its position is the point whose image is the centroid of its silhouette, in
// every pose, at every distance and under every distortion. The solid is displaced across the line
// of sight accordingly (a flapping bird bobs against its wings). So the centroid of the pixels it
// darkens is the projected position, and true observations need no correction for the pose.

#ifndef FLOCKLIFT_SIMULATE_RENDER_BODY_H_
#define FLOCKLIFT_SIMULATE_RENDER_BODY_H_

#include <optional>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/animal.h"
#include "simulate/core/rigid3.h"
#include "simulate/core/vec3.h"
#include "simulate/render/silhouette.h"

namespace flocklift {

// A convex piece of the solid: the hull of its corners [m].
struct BodyPart {
  std::array<Vec3d, ConvexPolygon::kMaxCorners> corner;
  int corners = 0;

  void Add(const Vec3d& point) { corner[static_cast<std::size_t>(corners++)] = point; }
};

// The parts whose union, seen from `viewer_in_body` [m], is the animal at `time` [s]; body frame,
// origin between the wings.
std::vector<BodyPart> BodyParts(const Animal& animal, double time, const Vec3d& viewer_in_body);

// An animal in flight.
struct FlyingAnimal {
  Animal animal;
  Vec3d position;  // world [m]
  Vec3d velocity;  // world [m/s]
  Rotation3d world_from_body;
};

struct ProjectedBody {
  Vec2d center;      // the projected position, and the silhouette's centroid [px]
  double depth = 0;  // camera-frame z of the position [m]
  Silhouette silhouette;
  SilhouetteMoments moments;  // of the silhouette
};

// Nothing when a part of the animal is not in front of the camera, when the distortion has folded
// its place in the image, or when it is farther outside the image than it is large.
std::optional<ProjectedBody> ProjectBody(const FlyingAnimal& flying, double time,
                                         const Camera& camera, const Rigid3d& cam_from_world);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_BODY_H_
