// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a film shows of a scene besides its animals, as the switches of [render] say.

#ifndef FLOCKLIFT_TOOLS_SCENE_SCENERY_H_
#define FLOCKLIFT_TOOLS_SCENE_SCENERY_H_

#include <span>

#include "simulate/core/scene.h"
#include "simulate/flock/world.h"
#include "simulate/render/scenery.h"

namespace flocklift {

// `obstacles` are the scene's, with their meshes read. Goals follow their motion and the scene's
// events; one without a reach is drawn a fiftieth of the box in radius.
Scenery SceneScenery(const Scene& scene, std::span<const Obstacle> obstacles);

// Only what hides animals.
Scenery SceneObstacles(std::span<const Obstacle> obstacles);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_SCENE_SCENERY_H_
