// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/camera_path.h"

#include <fmt/format.h>

#include <algorithm>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

void CheckKeys(std::span<const CameraKey> keys) {
  Check(!keys.empty(), "a camera path needs a key position");
  for (std::size_t k = 1; k < keys.size(); ++k) {
    Check(keys[k].time > keys[k - 1].time, "the times of a camera path must increase");
  }
}

// The value of one of the keys' points.
using Member = Vec3d CameraKey::*;

Vec3d Slope(std::span<const CameraKey> keys, Member member, std::size_t k) {
  return (keys[k + 1].*member - keys[k].*member) / (keys[k + 1].time - keys[k].time);
}

Vec3d Velocity(std::span<const CameraKey> keys, Member member, std::size_t k) {
  if (k == 0 || k + 1 == keys.size()) return {};
  const double before = keys[k].time - keys[k - 1].time, after = keys[k + 1].time - keys[k].time;
  return (after * Slope(keys, member, k - 1) + before * Slope(keys, member, k)) / (before + after);
}

Vec3d Hermite(std::span<const CameraKey> keys, Member member, std::size_t k, double time) {
  const double h = keys[k + 1].time - keys[k].time, t = (time - keys[k].time) / h;
  const double t2 = t * t, t3 = t2 * t;
  return (1 - 3 * t2 + 2 * t3) * (keys[k].*member) + (3 * t2 - 2 * t3) * (keys[k + 1].*member) +
         h * (t - 2 * t2 + t3) * Velocity(keys, member, k) +
         h * (t3 - t2) * Velocity(keys, member, k + 1);
}

}  // namespace

CameraKey CameraKeyAt(std::span<const CameraKey> keys, double time) {
  CheckKeys(keys);
  CameraKey at = time <= keys.front().time ? keys.front() : keys.back();
  if (time > keys.front().time && time < keys.back().time) {
    const auto next =
        std::upper_bound(keys.begin(), keys.end(), time,
                         [](double wanted, const CameraKey& key) { return wanted < key.time; });
    const auto k = static_cast<std::size_t>(next - keys.begin()) - 1;
    at.position = Hermite(keys, &CameraKey::position, k, time);
    at.look_at = Hermite(keys, &CameraKey::look_at, k, time);
  }
  at.time = time;
  return at;
}

std::vector<Rigid3d> FollowKeys(std::span<const CameraKey> keys, double fps, int frames) {
  Check(fps > 0, "fps must be positive to move a camera");
  std::vector<Rigid3d> poses;
  for (int frame = 1; frame <= frames; ++frame) {
    const CameraKey at = CameraKeyAt(keys, (frame - 1) / fps);
    Check(Norm(at.look_at - at.position) > 1e-6,
          fmt::format("in frame {} the camera is at the point that it looks at", frame));
    poses.push_back(LookAt(at.position, at.look_at));
  }
  return poses;
}

}  // namespace flocklift
