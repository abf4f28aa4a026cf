// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/camera.h"

#include <cmath>
#include <numbers>
#include <string>

#include "simulate/core/check.h"

namespace flocklift {

Rigid3d Camera::CamFromWorld(int frame) const {
  const auto frames = cam_from_world_per_frame.size();
  if (frame >= 1 && static_cast<std::size_t>(frame) <= frames) {
    return cam_from_world_per_frame[static_cast<std::size_t>(frame) - 1];
  }
  Check(frames == 0 || cam_from_world.has_value(),
        "the camera's pose in frame " + std::to_string(frame) +
            " is not known: cam_from_world_per_frame has " + std::to_string(frames) + " rows");
  return cam_from_world.value_or(Rigid3d{});
}

bool Camera::Sees(const Vec2d& pixel) const {
  return pixel.x >= -0.5 && pixel.x <= width - 0.5 && pixel.y >= -0.5 && pixel.y <= height - 0.5;
}

Camera PinholeCamera(double horizontal_fov_deg, int width, int height) {
  Check(horizontal_fov_deg > 0 && horizontal_fov_deg < 180,
        "the field of view must lie between 0 and 180 degrees");
  Check(width > 0 && height > 0, "the image size must be positive");
  const double focal = 0.5 * width / std::tan(horizontal_fov_deg * std::numbers::pi / 360);
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.intrinsics = {focal, focal, 0.5 * (width - 1), 0.5 * (height - 1), {}};
  return camera;
}

}  // namespace flocklift
