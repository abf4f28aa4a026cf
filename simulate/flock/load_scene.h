// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solid things of a scene: meshes read from files, scaled, turned and placed.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_LOAD_SCENE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_LOAD_SCENE_H_

#include <vector>

#include "simulate/core/rng.h"
#include "simulate/core/scene.h"
#include "simulate/core/triangle_mesh.h"
#include "simulate/flock/world.h"

namespace flocklift {

// InputError for a file that cannot be read, or whose surface is not closed: inside and outside
// would be undefined.
std::vector<Obstacle> LoadObstacles(const Scene& scene);

// InputError for a file that cannot be read, or an animation whose key-frames differ in more than
// the places of their vertices.
std::vector<ShapeInTime> LoadShapes(const Scene& scene);

// Points of a surface, each part of it as likely as its area says.
class SurfaceDraw {
 public:
  explicit SurfaceDraw(const TriangleMesh& mesh);
  Vec3d Draw(Rng* rng) const;

 private:
  TriangleMesh mesh_;
  std::vector<double> area_up_to_;  // of the triangles, summed [m^2]
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_LOAD_SCENE_H_
