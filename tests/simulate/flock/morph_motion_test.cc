// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/morph_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "simulate/core/check.h"
#include "simulate/flock/engine.h"
#include "simulate/shapes/animated_mesh_frames.h"
#include "simulate/shapes/solid_meshes.h"

namespace flocklift {
namespace {

constexpr int kCount = 600;

// A box that becomes a ball, 15 m farther on, around another ball.
World MakeWorld() {
  World world;
  world.dt = 1.0 / 60;
  world.shapes.push_back({"box", {0}, {BoxMesh({-1, -1, -1}, {1, 1, 1})}, 0, ""});
  world.shapes.push_back({"ball", {0}, {BallMesh({15, 0, 0}, 1.3, 3)}, 0, ""});
  world.paths.push_back({.name = "ahead", .points = {{5, 0, 0}, {10, 0, 0}}, .width = 6});
  world.obstacles.push_back({BallMesh({7, 0.1, 0}, 1, 2), Ball{{7, 0.1, 0}, 1}});
  return world;
}

Swarm MakeSwarm() {
  Swarm swarm;
  swarm.species = "tetrahedron";
  swarm.spec.name = "morph";
  swarm.spec.parameters = {{"departure_time", 0.5}, {"d_min", 0.05}, {"k_a", 0.4}};
  swarm.model = ResolveModel(swarm.spec);
  swarm.position.resize(kCount);
  swarm.velocity.resize(kCount);
  swarm.start_shape = "box";
  swarm.shape = "ball";
  swarm.path = "ahead";
  return swarm;
}

double VolumeOf(const std::vector<Vec3<float>>& corners) {
  double sum = 0;
  for (std::size_t k = 0; k < corners.size(); k += 4) {
    Tetra t;
    for (std::size_t c = 0; c < 4; ++c) {
      t[c] = {corners[k + c].x, corners[k + c].y, corners[k + c].z};
    }
    sum += Volume(t);
  }
  return sum;
}

TEST(MorphMotion, ABoxBecomesABall) {
  Engine engine(MakeWorld(), {MakeSwarm()}, {});
  std::vector<Vec3<float>> corners = engine.TetrahedraCorners();
  ASSERT_EQ(corners.size(), 4u * kCount);
  EXPECT_NEAR(VolumeOf(corners), 8, 0.1);
  double deepest = 0;
  for (int step = 0; step < 300; ++step) {
    engine.Step();
    for (const Vec3d& p : engine.State().position) {
      deepest = std::max(deepest, 1 - Norm(p - Vec3d{7, 0.1, 0}));
    }
  }
  EXPECT_LT(deepest, 0.06);  // not through the obstacle
  corners = engine.TetrahedraCorners();
  EXPECT_NEAR(VolumeOf(corners), EnclosedVolume(BallMesh({15, 0, 0}, 1.3, 3)), 0.8);
  for (const Vec3<float>& p : corners) {
    EXPECT_LT(Norm(Vec3d{p.x, p.y, p.z} - Vec3d{15, 0, 0}), 1.31);
  }
  EXPECT_GT(engine.MdeShare(), 0);
}

TEST(MorphMotion, WaitsForItsStartTime) {
  Swarm swarm = MakeSwarm();
  swarm.spec.parameters["start_time"] = 1;
  swarm.model = ResolveModel(swarm.spec);
  Engine engine(MakeWorld(), {swarm}, {});
  const std::vector<Vec3d> start = engine.State().position;
  for (int step = 0; step < 59; ++step) engine.Step();
  EXPECT_EQ(engine.State().position, start);
  for (int step = 0; step < 5; ++step) engine.Step();
  EXPECT_NE(engine.State().position, start);
}

TEST(MorphMotion, GoesOnFromASavedState) {
  Engine engine(MakeWorld(), {MakeSwarm()}, {});
  for (int step = 0; step < 70; ++step) engine.Step();
  const std::string saved = engine.Save();
  Engine other(MakeWorld(), {MakeSwarm()}, {});
  other.Load(saved);
  for (int step = 0; step < 60; ++step) {
    engine.Step();
    other.Step();
  }
  EXPECT_EQ(engine.TetrahedraCorners(), other.TetrahedraCorners());
  EXPECT_EQ(engine.State().position, other.State().position);
  EXPECT_EQ(engine.State().velocity, other.State().velocity);
}

TEST(MorphMotion, SameBytesWithOneAndTwoThreads) {
  Engine one(MakeWorld(), {MakeSwarm()}, {.threads = 1, .kernel = ""}),
      two(MakeWorld(), {MakeSwarm()}, {.threads = 2, .kernel = ""});
  for (int step = 0; step < 100; ++step) {
    one.Step();
    two.Step();
  }
  EXPECT_EQ(one.TetrahedraCorners(), two.TetrahedraCorners());
  EXPECT_EQ(one.State().position, two.State().position);
  EXPECT_EQ(one.State().velocity, two.State().velocity);
}

TEST(MorphMotion, NeedsTwoShapes) {
  Swarm swarm = MakeSwarm();
  swarm.start_shape = "";
  EXPECT_THROW(Engine(MakeWorld(), {swarm}, {}), std::invalid_argument);
}

void ExpectBlamed(const Swarm& swarm, const std::string& fault) {
  try {
    const Engine engine(MakeWorld(), {swarm}, {});
    ADD_FAILURE() << "nothing was thrown: " << fault;
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("scene.toml:7: " + fault), 0U) << error.what();
  }
}

TEST(MorphMotion, FaultsOfASceneAreToldWithTheirPlace) {
  Swarm swarm = MakeSwarm();
  swarm.spec.where = "scene.toml:7";
  Swarm nowhere = swarm, formless = swarm, pushed = swarm, few = swarm;
  nowhere.start_shape = "";
  formless.shape = "none of them";
  pushed.forces.push_back({.name = "wind_drag", .parameters = {}, .where = {}, .where_of = {}});
  ExpectBlamed(nowhere, "the model morph of the species tetrahedron has no start; ");
  ExpectBlamed(formless, "the model morph of the species tetrahedron has no shape; ");
  ExpectBlamed(pushed, "the model morph sets velocities and takes no [[species.force]]; ");
  // What only its library finds amiss: too few to fill a box.
  few.position.resize(1);
  few.velocity.resize(1);
  ExpectBlamed(few, "");
}

}  // namespace
}  // namespace flocklift
