// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An assimp scene as it stands at a moment of its animation. Only for sources: it drags in assimp.
//   point_in_scene = scene_from_node point                            a mesh of a node
//   point_in_scene = sum_b w_b scene_from_bone_b bone_from_mesh_b p   a skinned mesh
//   p = base + sum_m w_m (target_m - base)                            with morph targets

#ifndef FLOCKLIFT_SIMULATE_SHAPES_ASSIMP_POSE_H_
#define FLOCKLIFT_SIMULATE_SHAPES_ASSIMP_POSE_H_

#include <assimp/scene.h>

#include "simulate/shapes/weld.h"

namespace flocklift::internal {

// All triangles of the scene, posed at `time` [ticks of the animation]; without an animation (null)
// as the nodes stand in the file. Points, lines and what else is no triangle are left out.
Soup PosedSoup(const aiScene& scene, const aiAnimation* animation, double time);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_SHAPES_ASSIMP_POSE_H_
