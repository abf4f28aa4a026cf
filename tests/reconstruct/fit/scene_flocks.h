// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Small scenes of the models that fly to what a scene holds, for the tests of fit and replay.

#ifndef FLOCKLIFT_TESTS_RECONSTRUCT_FIT_SCENE_FLOCKS_H_
#define FLOCKLIFT_TESTS_RECONSTRUCT_FIT_SCENE_FLOCKS_H_

#include <filesystem>

#include "reconstruct/fit/fit.h"
#include "tests/reconstruct/fit/flocks.h"

namespace flocklift {

inline std::filesystem::path Mesh(const char* name) {
  return std::filesystem::path(FLOCKLIFT_SOURCE_DIR) / "data_synthetic/meshes" / name;
}

inline ShapeSpec Shape(const char* name, const char* mesh, const Vec3d& position, double scale) {
  ShapeSpec shape;
  shape.name = name;
  shape.key_frames = {{Mesh(mesh), 0}};
  shape.placement.position = position;
  shape.placement.scale = scale;
  return shape;
}

inline Scene EmptyScene(const char* model, int count) {
  Scene scene;
  scene.seed = 5;
  scene.fps = 15;
  scene.substeps = 1;
  SpeciesSpec species;
  species.count = count;
  species.wingspan = 0.1;
  species.speed = 0.4;
  species.model.name = model;
  scene.species = {species};
  return scene;
}

// Flies about a star that already stands.
inline Scene ShapeScene() {
  Scene scene = EmptyScene("shape", 80);
  scene.duration = 3;
  scene.warmup = 2;
  SpeciesSpec& flies = scene.species[0];
  flies.start = Region{{-1, -1, 7}, {1, 1, 9}};
  flies.shape = "star";
  flies.model.parameters = {{"alpha", 0.6}, {"s_max", 0.6}, {"w_dis", 6}};
  scene.shapes = {Shape("star", "star.ply", {0, 0, 8}, 1)};
  return scene;
}

// Two groups that change places past a block.
inline Scene CrowdScene() {
  Scene scene = EmptyScene("crowd", 40);
  scene.fps = 10;
  scene.duration = 4;
  scene.box = {{-10, -5, 0}, {10, 5, 0.5}};
  SpeciesSpec& walkers = scene.species[0];
  walkers.start = Region{{-7, -4, 0}, {7, 4, 0.5}};
  walkers.model.parameters = {{"f_max", 1.4}, {"f_min", 0.3}, {"cell", 1}, {"d_min", 0.4}};
  for (const double x : {-8.0, 8.0}) {
    GoalSpec goal;
    goal.position = {x, 0, 0};
    goal.reach = 1;
    scene.goals.push_back(goal);
  }
  ObstacleSpec block;
  block.box = Region{{-0.5, -1.5, 0}, {0.5, 1.5, 1}};
  scene.obstacles = {block};
  return scene;
}

inline Scene MorphScene() {
  Scene scene = EmptyScene("morph", 60);
  scene.duration = 4;
  SpeciesSpec& tetrahedra = scene.species[0];
  tetrahedra.start_shape = "moon";
  tetrahedra.shape = "star";
  tetrahedra.model.parameters = {{"speed0", 8},         {"omega1", 0.7}, {"omega2", 0.3},
                                 {"departure_time", 2}, {"gain", 0.5},   {"scale", 0.8}};
  tetrahedra.model.choices["style"] = "curl";
  scene.shapes = {Shape("moon", "moon.ply", {0, 0, 12}, 2),
                  Shape("star", "star.ply", {18, 0, 12}, 2)};
  return scene;
}

inline FitProblem ProblemOf(const Scene& scene) {
  FitProblem problem;
  problem.model = scene.species[0].model;
  problem.scene = scene;
  return problem;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_RECONSTRUCT_FIT_SCENE_FLOCKS_H_
