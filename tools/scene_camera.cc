// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/scene_camera.h"

#include "simulate/camera/camera_io.h"
#include "simulate/camera/camera_path.h"
#include "simulate/core/rigid3.h"

namespace flocklift {

Camera Resized(const Camera& camera, int width, int height) {
  const double scale = static_cast<double>(width) / camera.width;
  Camera resized = camera;
  resized.width = width;
  resized.height = height;
  Intrinsics& k = resized.intrinsics;
  k.fx *= scale;
  k.fy *= scale;
  k.cx = scale * (k.cx - 0.5 * (camera.width - 1)) + 0.5 * (width - 1);
  k.cy = scale * (k.cy - 0.5 * (camera.height - 1)) + 0.5 * (height - 1);
  return resized;
}

Camera SceneCamera(const Scene& scene, std::optional<std::pair<int, int>> size) {
  const CameraSpec& spec = scene.camera;
  Camera camera;
  if (spec.file) {
    camera = ReadCamera(*spec.file);
  } else {
    camera = PinholeCamera(spec.fov_deg, spec.width, spec.height);
    if (spec.path.empty()) {
      camera.cam_from_world = LookAt(spec.position, spec.look_at);
    } else {
      camera.cam_from_world_per_frame = FollowKeys(spec.path, scene.fps, scene.FrameCount());
    }
  }
  camera.fps = scene.fps;
  return size ? Resized(camera, size->first, size->second) : camera;
}

}  // namespace flocklift
