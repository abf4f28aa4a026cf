// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A flock on circles, by formula, and what a camera sees of it: truth for twin experiments. Nothing
// here is the solver's own model: paths are sums of sines, errors of size are a wingbeat.

#ifndef FLOCKLIFT_TESTS_RECONSTRUCT_CIRCLING_FLOCK_H_
#define FLOCKLIFT_TESTS_RECONSTRUCT_CIRCLING_FLOCK_H_

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "simulate/camera/camera.h"
#include "simulate/camera/projection.h"
#include "simulate/core/observations.h"
#include "simulate/core/rng.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct FlockSpec {
  int count = 12;
  int frames = 150;
  double fps = 30;
  double speed = 10;  // mean [m/s]
  double speed_spread = 0.05;
  double wingspan = 0.6;  // mean [m]
  double wingspan_spread = 0.04;
  double radius = 12;  // of the circles [m]
  Vec3d center{0, 0, 15};
  std::uint64_t seed = 1;
};

// True paths, ids from 1, every animal in every frame.
inline Trajectories CirclingFlock(const FlockSpec& spec) {
  Trajectories truth;
  truth.fps = spec.fps;
  for (int i = 1; i <= spec.count; ++i) {
    Rng rng(spec.seed, static_cast<std::uint64_t>(i));
    const double speed = spec.speed * std::exp(spec.speed_spread * rng.Normal());
    const double radius = spec.radius + 2 * rng.Normal();
    const double start = 0.3 * rng.Normal();
    const double height = 2 * rng.Normal();
    const double wave = rng.Uniform(0.15, 0.3), phase = rng.Uniform(0, 2 * std::numbers::pi);
    Trajectory path{i, {}};
    for (int f = 1; f <= spec.frames; ++f) {
      const double t = (f - 1) / spec.fps;
      const double swing = std::sin(2 * std::numbers::pi * wave * t + phase);
      const double angle = start + speed / radius * t;
      const double r = radius + 0.5 * swing;
      TrajectoryPoint point;
      point.frame = f;
      point.position =
          spec.center + Vec3d{r * std::cos(angle), r * std::sin(angle), height + 0.4 * swing};
      path.points.push_back(point);
    }
    truth.trajectories.push_back(path);
  }
  ComputeVelocities(spec.fps, &truth);
  return truth;
}

// A camera 45 m south of the world's origin that looks north and up.
inline Camera WatchingCamera() {
  Camera camera = PinholeCamera(50, 1920, 1080);
  camera.cam_from_world = LookAt({0, -45, 1.7}, {0, 0, 15});
  return camera;
}

// Noise of what is seen.
struct NoiseSpec {
  double pixel_sd = 0.5;
  double wingbeat = 0.1;  // amplitude of log size
  std::uint64_t seed = 7;
};

// Boxes of animals whose size does not depend on the view, in view or not.
inline Tracks Observe(const FlockSpec& spec, const NoiseSpec& noise, const Trajectories& truth,
                      const Camera& camera) {
  Tracks tracks;
  tracks.fps = spec.fps;
  for (const Trajectory& path : truth.trajectories) {
    Rng individual(spec.seed + 1000, static_cast<std::uint64_t>(path.id));
    const double wingspan = spec.wingspan * std::exp(spec.wingspan_spread * individual.Normal());
    const double beat = individual.Uniform(4, 6), phase = individual.Uniform(0, 6.28);
    Tracklet tracklet{path.id, {}};
    for (const TrajectoryPoint& point : path.points) {
      const Vec3d in_cam = camera.CamFromWorld(point.frame) * point.position;
      if (in_cam.z <= 0) continue;
      Rng rng(noise.seed, static_cast<std::uint64_t>(path.id),
              static_cast<std::uint32_t>(point.frame));
      Vec2d pixel = Project(camera.intrinsics, in_cam);
      pixel.x += noise.pixel_sd * rng.Normal();
      pixel.y += noise.pixel_sd * rng.Normal();
      const double flap = std::sin(2 * std::numbers::pi * beat * point.frame / spec.fps + phase);
      const double size =
          camera.intrinsics.fx * wingspan / in_cam.z * std::exp(noise.wingbeat * flap);
      Detection detection;
      detection.frame = point.frame;
      detection.box = Box::Around(pixel, 0.9 * size, 0.3 * size);
      tracklet.detections.push_back(detection);
    }
    if (!tracklet.detections.empty()) tracks.tracklets.push_back(tracklet);
  }
  return tracks;
}

// Depths of both in every row that both have: (true, found), by id and frame.
using DepthPairs = std::map<std::pair<Id, int>, std::pair<double, double>>;
inline DepthPairs PairDepths(const Trajectories& truth, const Trajectories& found,
                             const Camera& camera) {
  std::map<std::pair<Id, int>, double> depths;
  for (const Trajectory& path : truth.trajectories) {
    for (const TrajectoryPoint& p : path.points) {
      depths[{path.id, p.frame}] = (camera.CamFromWorld(p.frame) * p.position).z;
    }
  }
  DepthPairs pairs;
  for (const Trajectory& path : found.trajectories) {
    for (const TrajectoryPoint& p : path.points) {
      const auto depth = depths.find({path.id, p.frame});
      if (depth == depths.end()) continue;
      pairs[depth->first] = {depth->second, (camera.CamFromWorld(p.frame) * p.position).z};
    }
  }
  return pairs;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_RECONSTRUCT_CIRCLING_FLOCK_H_
