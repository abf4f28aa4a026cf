// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The camera that a scene asks for.

#ifndef FLOCKLIFT_TOOLS_SCENE_CAMERA_H_
#define FLOCKLIFT_TOOLS_SCENE_CAMERA_H_

#include <optional>
#include <utility>

#include "simulate/camera/camera.h"
#include "simulate/core/scene.h"

namespace flocklift {

// From the file or the keys of [camera]; with a path, one pose for each frame. With a `size` [px]
// the image is another one of the same view: as wide an angle, and what is above and below follows.
Camera SceneCamera(const Scene& scene, std::optional<std::pair<int, int>> size = {});

// The same view in another size: focal lengths, and the principal point's distance from the middle,
// grow like the width.
Camera Resized(const Camera& camera, int width, int height);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_SCENE_CAMERA_H_
