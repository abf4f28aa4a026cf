// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/scene_input.h"

#include "simulate/core/scene_io.h"

namespace flocklift {

void AddMeshInputs(const Scene& scene, Stage* stage) {
  for (const ObstacleSpec& obstacle : scene.obstacles) {
    if (obstacle.mesh) stage->AddInput(*obstacle.mesh);
  }
  for (const ShapeSpec& shape : scene.shapes) {
    for (const ShapeSpec::KeyFrame& frame : shape.key_frames) stage->AddInput(frame.mesh);
  }
}

Scene ReadSceneAsInput(const std::filesystem::path& path, Stage* stage) {
  stage->options()["scene"] = path.string();
  stage->AddInput(path);
  Scene scene = ReadScene(path);
  AddMeshInputs(scene, stage);
  return scene;
}

}  // namespace flocklift
