// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/synthetic.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "simulate/camera/projection.h"
#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/observe_frames.h"
#include "simulate/render/body.h"
#include "simulate/render/flight.h"
#include "simulate/render/speck.h"
#include "simulate/render/visibility.h"

namespace flocklift {
namespace {

constexpr std::uint64_t kClutterStream = 0x636c7574746572;
constexpr std::uint64_t kOrderStream = 0x6f72646572;

// The place in the image, if the sensor has it; a first look before any body is made.
std::optional<Vec2d> PlaceOnSensor(const Vec3d& in_cam, const Camera& camera) {
  if (!(in_cam.z > 0)) return std::nullopt;
  const Vec2d pixel = Project(camera.intrinsics, in_cam);
  return camera.Sees(pixel) ? std::optional(pixel) : std::nullopt;
}

std::optional<Detection> ObserveBody(const FlyingAnimal& animal, double time, const Camera& camera,
                                     const Rigid3d& cam_from_world, const DepthBuffer* surfaces) {
  const auto body = ProjectBody(animal, time, camera, cam_from_world);
  if (!body || !camera.Sees(body->center)) return std::nullopt;
  const Box bounds = BoundsOf(body->silhouette);
  Detection seen;
  seen.box = Box::Around(body->center, bounds.width, bounds.height);
  seen.shape = ShapeOf(body->moments);
  if (surfaces != nullptr) seen.visibility = VisibleShare(*body, *surfaces);
  return seen;
}

std::optional<Detection> ObserveSpeck(const FlyingAnimal& animal, double time,
                                      const SpeckAreas& areas, const Camera& camera,
                                      const Rigid3d& cam_from_world, const DepthBuffer* surfaces) {
  const auto speck = ProjectSpeckBox(animal, time, areas, camera, cam_from_world);
  if (!speck) return std::nullopt;
  const Vec2d center = speck->moments.centroid;
  Detection seen;
  seen.box = Box::Around(center, 2 * speck->half_width, 2 * speck->half_height);
  seen.shape = ShapeOf(speck->moments);
  if (surfaces != nullptr) seen.visibility = VisibleShare(center, speck->depth, *surfaces);
  return seen;
}

// Random numbers drawn in a fixed order, so that one kind of noise does not change another.
std::optional<Detection> Disturb(const ObservationNoise& noise, std::uint64_t seed, Id id,
                                 const Detection& truth) {
  Rng rng(seed, static_cast<std::uint64_t>(id), static_cast<std::uint32_t>(truth.frame));
  const bool missed = rng.Uniform() < noise.miss;
  const double du = noise.position_sd * rng.Normal(), dv = noise.position_sd * rng.Normal();
  const double scale = std::exp(noise.size_sd * rng.Normal());
  if (missed) return std::nullopt;
  Detection seen = truth;
  const Vec2d center = truth.box.Center();
  seen.box = Box::Around({center.x + du, center.y + dv}, scale * truth.box.width,
                         scale * truth.box.height);
  if (seen.shape) {
    seen.shape->major *= scale;
    seen.shape->minor *= scale;
    seen.shape->area *= scale * scale;
  }
  return seen;
}

// Poisson numbers by adding exponential waiting times.
int Poisson(double mean, Rng* rng) {
  int count = 0;
  for (double time = -std::log(rng->Uniform()); time < mean; time -= std::log(rng->Uniform())) {
    ++count;
  }
  return count;
}

}  // namespace

Tracks SynthesizeTracks(const Trajectories& trajectories, std::span<const Animal> animals,
                        const Camera& camera, double fps, int threads, const Scenery* scenery) {
  const Flight flight(trajectories, animals, camera, fps);
  const SpeckAreas areas;
  return ObserveFrames(
      flight.span(), fps, camera, scenery, threads,
      [&](int frame, const Rigid3d& cam_from_world, const DepthBuffer* surfaces,
          std::vector<SeenAnimal>* seen) {
        const double time = flight.TimeOf(frame);
        const auto is_in_view = [&](const Vec3d& position) {
          return PlaceOnSensor(cam_from_world * position, camera).has_value();
        };
        for (const FlyingAnimal& animal : flight.At(frame, is_in_view)) {
          const double depth = (cam_from_world * animal.position).z;
          auto found = SizePx(animal.animal, depth, camera) < kTablePx
                           ? ObserveSpeck(animal, time, areas, camera, cam_from_world, surfaces)
                           : ObserveBody(animal, time, camera, cam_from_world, surfaces);
          if (found) seen->push_back({animal.animal.id, *std::move(found)});
        }
      });
}

Tracks SynthesizeNoise(const ObservationNoise& noise, std::uint64_t seed, const Tracks& tracks) {
  CheckOptions(noise);
  Tracks noisy{.fps = tracks.fps, .tracklets = {}};
  for (const Tracklet& truth : tracks.tracklets) {
    Tracklet tracklet{.id = truth.id, .detections = {}};
    for (const Detection& detection : truth.detections) {
      auto seen = Disturb(noise, seed, truth.id, detection);
      if (seen) tracklet.detections.push_back(*seen);
    }
    if (!tracklet.detections.empty()) noisy.tracklets.push_back(std::move(tracklet));
  }
  return noisy;
}

std::vector<DetectionFrame> SynthesizeDetections(const ObservationNoise& noise, std::uint64_t seed,
                                                 const Camera& camera, const Tracks& tracks) {
  Check(camera.width > 0 && camera.height > 0, "a camera without a size has no room for clutter");
  const FrameSpan span = SpanOf(tracks);
  std::vector<DetectionFrame> frames;
  for (int frame = span.first; frame <= span.last; ++frame) {
    frames.push_back({.frame = frame, .detections = {}});
  }
  std::vector<Box> sizes;
  for (const Tracklet& tracklet : SynthesizeNoise(noise, seed, tracks).tracklets) {
    for (const Detection& detection : tracklet.detections) {
      frames[static_cast<std::size_t>(detection.frame - span.first)].detections.push_back(
          detection);
      sizes.push_back(detection.box);
    }
  }
  for (DetectionFrame& frame : frames) {
    auto& detections = frame.detections;
    Rng clutter(seed, kClutterStream, static_cast<std::uint32_t>(frame.frame));
    const int count = sizes.empty() ? 0 : Poisson(noise.clutter, &clutter);
    for (int k = 0; k < count; ++k) {
      const Box& size = sizes[clutter.Below(static_cast<std::uint32_t>(sizes.size()))];
      const Vec2d center{clutter.Uniform(-0.5, camera.width - 0.5),
                         clutter.Uniform(-0.5, camera.height - 0.5)};
      detections.push_back({.frame = frame.frame,
                            .box = Box::Around(center, size.width, size.height),
                            .confidence = clutter.Uniform(kMeasuredConfidence, 0.9),
                            .shape = std::nullopt});
    }
    Rng order(seed, kOrderStream, static_cast<std::uint32_t>(frame.frame));
    for (std::size_t k = detections.size(); k > 1; --k) {
      std::swap(detections[k - 1], detections[order.Below(static_cast<std::uint32_t>(k))]);
    }
  }
  return frames;
}

}  // namespace flocklift
