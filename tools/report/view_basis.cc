// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report/view_basis.h"

namespace flocklift {

ViewBasis::ViewBasis(const Camera& camera, int frame) {
  const Rigid3d world_from_cam = camera.CamFromWorld(frame).Inverse();
  camera_in_world_ = world_from_cam.translation;
  knows_gravity_ = camera.KnowsGravity();
  right_ = world_from_cam.rotation * Vec3d{1, 0, 0};
  ahead_ = world_from_cam.rotation * Vec3d{0, 0, 1};
  up_ = world_from_cam.rotation * Vec3d{0, -1, 0};
  if (!knows_gravity_) return;
  const Vec3d image_up = up_;
  up_ = {0, 0, 1};
  Vec3d level = ahead_ - up_ * Dot(ahead_, up_);
  if (Norm(level) < 0.05) level = image_up - up_ * Dot(image_up, up_);  // straight up or down
  ahead_ = Normalized(level);
  right_ = Cross(ahead_, up_);
}

Vec3d ViewBasis::Turned(const Vec3d& direction) const {
  return {Dot(direction, right_), Dot(direction, ahead_), Dot(direction, up_)};
}

Vec3d ViewBasis::FromWorld(const Vec3d& point) const {
  Vec3d turned = Turned(point - camera_in_world_);
  if (knows_gravity_) turned.z += camera_in_world_.z;
  return turned;
}

}  // namespace flocklift
