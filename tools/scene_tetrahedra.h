// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The species of a scene that are tetrahedra (model morph): their film is a moving surface instead
// of animals, and their true observations are those of tetrahedra.

#ifndef FLOCKLIFT_TOOLS_SCENE_TETRAHEDRA_H_
#define FLOCKLIFT_TOOLS_SCENE_TETRAHEDRA_H_

#include <filesystem>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/animal.h"
#include "simulate/core/scene.h"
#include "simulate/flock/simulate_scene.h"
#include "simulate/render/scenery.h"

namespace flocklift {

bool HasTetrahedra(const Scene& scene);

// Adds what SimulateScene wrote to `path`, read back frame by frame; each species has its colour.
void AddTetrahedra(const Scene& scene, const std::filesystem::path& path, Scenery* scenery);

// Adds their true observations, as SynthesizeTetrahedraTracks has them; tracks stay sorted by id.
void AddTetrahedraTracks(const Scene& scene, const SceneResult& result,
                         const std::filesystem::path& path, const Camera& camera, int threads,
                         const Scenery* scenery, Tracks* tracks);

// What of a result is left to be drawn as animals.
struct DrawnAnimals {
  Trajectories trajectories;
  std::vector<Animal> animals;
};
DrawnAnimals WithoutTetrahedra(const Scene& scene, const SceneResult& result);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_SCENE_TETRAHEDRA_H_
