// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/tetrahedra_tracks.h"

#include <array>
#include <optional>

#include "simulate/camera/projection.h"
#include "simulate/core/check.h"
#include "simulate/observe_frames.h"
#include "simulate/render/silhouette.h"
#include "simulate/render/visibility.h"

namespace flocklift {
namespace {

std::optional<Detection> Observe(std::span<const Vec3d, 4> corners, const Camera& camera,
                                 const Rigid3d& cam_from_world, const DepthBuffer* surfaces) {
  std::array<Vec2d, 4> image;
  Vec3d sum;
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3d in_cam = cam_from_world * corners[c];
    if (!(in_cam.z > 0)) return std::nullopt;
    image[c] = Project(camera.intrinsics, in_cam);
    sum += in_cam;
  }
  const Vec3d middle = 0.25 * sum;
  ProjectedBody body;
  body.center = Project(camera.intrinsics, middle);
  body.depth = middle.z;
  if (!camera.Sees(body.center)) return std::nullopt;
  const ConvexPolygon hull = HullOf(image);
  body.silhouette = UnionOf({&hull, 1});
  body.moments = MomentsOf(body.silhouette);
  if (!(body.moments.area > 0)) return std::nullopt;  // a needle seen along its length
  const Box bounds = BoundsOf(body.silhouette);
  Detection seen;
  seen.box = Box::Around(body.center, bounds.width, bounds.height);
  seen.shape = ShapeOf(body.moments);
  if (surfaces != nullptr) seen.visibility = VisibleShare(body, *surfaces);
  return seen;
}

}  // namespace

Tracks SynthesizeTetrahedraTracks(std::span<const Id> ids, const TetrahedraAt& corners_at,
                                  const FrameSpan& span, const Camera& camera, double fps,
                                  int threads, const Scenery* scenery) {
  return ObserveFrames(span, fps, camera, scenery, threads,
                       [&](int frame, const Rigid3d& cam_from_world, const DepthBuffer* surfaces,
                           std::vector<SeenAnimal>* seen) {
                         const std::vector<Vec3d> corners = corners_at(frame);
                         Check(corners.size() == 4 * ids.size(), "a tetrahedron has four corners");
                         for (std::size_t k = 0; k < ids.size(); ++k) {
                           auto found = Observe(std::span<const Vec3d, 4>(&corners[4 * k], 4),
                                                camera, cam_from_world, surfaces);
                           if (found) seen->push_back({ids[k], *std::move(found)});
                         }
                       });
}

}  // namespace flocklift
