// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/observe_frames.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "simulate/core/parallel_for.h"
#include "simulate/render/surface.h"

namespace flocklift {

Tracks ObserveFrames(const FrameSpan& span, double fps, const Camera& camera,
                     const Scenery* scenery, int threads, const ObserveFrame& observe) {
  constexpr std::int64_t kGrain = 32;  // frames that share one depth buffer
  const std::int64_t frames = std::max(0, span.last - span.first + 1);
  std::vector<std::vector<SeenAnimal>> seen(static_cast<std::size_t>(frames));
  const bool may_hide = scenery != nullptr && !scenery->empty();
  const SurfacePainter painter(camera);
  ParallelFor(threads, 0, frames, kGrain, [&](std::int64_t first, std::int64_t last) {
    std::unique_ptr<DepthBuffer> surfaces;
    if (may_hide) surfaces = std::make_unique<DepthBuffer>(camera.width, camera.height);
    std::optional<Rigid3d> drawn_from;
    for (std::int64_t k = first; k < last; ++k) {
      const int frame = span.first + static_cast<int>(k);
      const Rigid3d cam_from_world = camera.CamFromWorld(frame);
      if (surfaces && (scenery->SurfacesMove() || drawn_from != cam_from_world)) {
        surfaces->Clear();
        drawn_from = cam_from_world;
        scenery->WithSurfaces(frame, [&](std::span<const Surface> views) {
          for (const Surface& view : views) painter.Draw(view, cam_from_world, 0, surfaces.get());
        });
      }
      std::vector<SeenAnimal>& here = seen[static_cast<std::size_t>(k)];
      observe(frame, cam_from_world, surfaces.get(), &here);
      for (SeenAnimal& animal : here) animal.detection.frame = frame;
    }
  });
  std::map<Id, Tracklet> by_id;
  for (std::vector<SeenAnimal>& frame : seen) {
    for (SeenAnimal& animal : frame) {
      Tracklet& tracklet = by_id[animal.id];
      tracklet.id = animal.id;
      tracklet.detections.push_back(std::move(animal.detection));
    }
  }
  Tracks tracks{.fps = fps, .tracklets = {}};
  for (auto& [id, tracklet] : by_id) tracks.tracklets.push_back(std::move(tracklet));
  return tracks;
}

}  // namespace flocklift
