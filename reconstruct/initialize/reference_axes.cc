// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/reference_axes.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

Vec3d PlaceInWorld(const Camera& camera, int frame) {
  return camera.CamFromWorld(frame).Inverse().translation;
}

}  // namespace

ReferenceAxes::ReferenceAxes(const Camera& camera, int first_frame, int last_frame)
    : camera_(camera), first_frame_(first_frame), last_frame_(last_frame) {
  if (camera.cam_from_world_per_frame.empty() || last_frame < first_frame) {
    ref_from_world_ = camera.cam_from_world.value_or(Rigid3d{}).rotation;
    return;
  }
  Vec3d right, ahead;  // sums of the camera's axes
  const Vec3d place = PlaceInWorld(camera, first_frame);
  const Rotation3d first = camera.CamFromWorld(first_frame).rotation;
  for (int frame = first_frame; frame <= last_frame; ++frame) {
    const Rotation3d cam_from_world = camera.CamFromWorld(frame).rotation;
    const Rotation3d world_from_cam = cam_from_world.Inverse();
    right += world_from_cam * Vec3d{1, 0, 0};
    ahead += world_from_cam * Vec3d{0, 0, 1};
    turns_ |= !(cam_from_world == first);
    moves_ |= SquaredNorm(PlaceInWorld(camera, frame) - place) > 0;
  }
  constexpr double kLeast = 0.3;  // of the mean axis: a camera that looks half around has 0.64
  const double frames = last_frame - first_frame + 1;
  Check(Norm(ahead) > kLeast * frames,
        "the camera looks all around; cut the sequence into pieces and reconstruct each");
  const Vec3d z = Normalized(ahead);
  const Vec3d level = right - Dot(right, z) * z;
  Check(Norm(level) > kLeast * frames,
        "the camera rolls all around; cut the sequence into pieces and reconstruct each");
  const Vec3d x = Normalized(level);
  ref_from_world_ = turns_ ? Rotation3d::FromRows(x, Cross(z, x), z) : first;
}

Rigid3d ReferenceAxes::WorldFromRef(int frame) const {
  return {ref_from_world_.Inverse(), PlaceInWorld(camera_, frame)};
}

Rigid3d ReferenceAxes::WorldFromRef(double frame) const {
  if (!moves_) return WorldFromRef(first_frame_);
  const double inside =
      std::clamp(frame, static_cast<double>(first_frame_), static_cast<double>(last_frame_));
  const int left = std::min(static_cast<int>(inside), last_frame_ - 1);
  const Rigid3d before = WorldFromRef(left), after = WorldFromRef(left + 1);
  const double share = inside - left;
  return {before.rotation, (1 - share) * before.translation + share * after.translation};
}

Rigid3d ReferenceAxes::RefFromWorld(int frame) const { return WorldFromRef(frame).Inverse(); }

Vec3d ReferenceAxes::CameraPlace(int frame) const {
  if (!moves_) return {};
  return ref_from_world_ * (PlaceInWorld(camera_, frame) - PlaceInWorld(camera_, first_frame_));
}

double ReferenceAxes::DepthInCam(int frame, const Vec3d& position_in_ref) const {
  if (!turns_) return position_in_ref.z;
  const Vec3d in_world = ref_from_world_.Inverse() * position_in_ref;
  return (camera_.CamFromWorld(frame).rotation * in_world).z;
}

std::optional<ReferenceAxes::Turned> ReferenceAxes::Turn(int frame, const Vec2d& ray) const {
  if (!turns_) return Turned{ray, 1};
  const Vec3d in_cam{ray.x, ray.y, 1};
  const Vec3d in_ref = ref_from_world_ * (camera_.CamFromWorld(frame).rotation.Inverse() * in_cam);
  constexpr double kCosine = 0.2588;  // of 75 degrees
  if (in_ref.z < kCosine * Norm(in_cam)) return std::nullopt;
  // The map of one picture plane to the other enlarges areas by z^-3.
  return Turned{{in_ref.x / in_ref.z, in_ref.y / in_ref.z}, std::pow(in_ref.z, -1.5)};
}

}  // namespace flocklift
