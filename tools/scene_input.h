// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A scene as an input of a stage.

#ifndef FLOCKLIFT_TOOLS_SCENE_INPUT_H_
#define FLOCKLIFT_TOOLS_SCENE_INPUT_H_

#include <filesystem>

#include "simulate/core/scene.h"
#include "tools/stage.h"

namespace flocklift {

// The meshes of the scene's obstacles and shapes.
void AddMeshInputs(const Scene& scene, Stage* stage);

// Reads the scene; it and its meshes are inputs, its name an option.
Scene ReadSceneAsInput(const std::filesystem::path& path, Stage* stage);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_SCENE_INPUT_H_
