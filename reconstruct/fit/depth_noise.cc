// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/depth_noise.h"

#include <array>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr int kWaves = 32;  // M
constexpr std::uint64_t kStream = std::uint64_t{0xF17} << 48;

class SmoothNoise {
 public:
  SmoothNoise(Rng rng, double time) {
    for (Wave& wave : waves_) {
      wave.frequency = rng.Normal() / time;
      wave.cosine = rng.Normal() / std::sqrt(kWaves);
      wave.sine = rng.Normal() / std::sqrt(kWaves);
    }
  }
  double At(double t) const {
    double sum = 0;
    for (const Wave& wave : waves_) {
      sum += wave.cosine * std::cos(wave.frequency * t) + wave.sine * std::sin(wave.frequency * t);
    }
    return sum;
  }

 private:
  struct Wave {
    double frequency = 0, cosine = 0, sine = 0;
  };
  std::array<Wave, kWaves> waves_;
};

}  // namespace

Vec3d DepthDirection(const std::optional<Camera>& camera, int frame, const Vec3d& position) {
  if (!camera) return Normalized(position);
  const Rigid3d cam_from_world = camera->CamFromWorld(frame);
  const Vec3d in_cam = cam_from_world * position;
  const Vec3d eye = cam_from_world.Inverse().translation;
  return std::abs(in_cam.z) > 1e-9 ? (position - eye) / in_cam.z : Normalized(position - eye);
}

DepthShare DepthShareOf(const std::optional<Camera>& camera, int frame, const Vec3d& position,
                        double sd_depth, double scale_sd) {
  const double length = Norm(DepthDirection(camera, frame, position));
  DepthShare share{.sight = position};
  if (camera) share.sight -= camera->CamFromWorld(frame).Inverse().translation;
  if (length == 0 || Norm(share.sight) == 0) return share;
  const double relative = sd_depth * length / Norm(share.sight);
  share.own = std::sqrt(std::max(0.0, relative * relative - scale_sd * scale_sd));
  return share;
}

Trajectories AddDepthNoise(const DepthNoiseOptions& options, const std::optional<Camera>& camera,
                           double fps, const Trajectories& trajectories) {
  Check(options.time > 0 && fps > 0, "depth noise needs a positive time and frame rate");
  Trajectories noisy = trajectories;
  for (Trajectory& trajectory : noisy.trajectories) {
    const auto agent = kStream | static_cast<std::uint64_t>(trajectory.id);
    const SmoothNoise noise(Rng(options.seed, agent, options.draw), options.time);
    for (TrajectoryPoint& point : trajectory.points) {
      const DepthShare share =
          DepthShareOf(camera, point.frame, point.position, point.sd_depth, options.scale_sd);
      point.position += (share.own * noise.At((point.frame - 1) / fps)) * share.sight;
    }
  }
  return noisy;
}

}  // namespace flocklift
