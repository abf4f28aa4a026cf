// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/simulate_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "simulate/core/check.h"
#include "simulate/core/scene_io.h"

namespace flocklift {
namespace {

Scene SmallScene() {
  Scene scene;
  scene.duration = 1;
  scene.warmup = 0.5;
  SpeciesSpec species;
  species.count = 20;
  scene.species = {species};
  return scene;
}

TEST(SimulateScene, FramesIdsAndFigures) {
  const SceneResult result = SimulateScene(SmallScene(), {}, {});
  EXPECT_EQ(result.agents, 20);
  EXPECT_EQ(result.steps, (15 + 29) * 4);  // the last frame needs no step after it
  EXPECT_GT(result.mean_neighbours, 1);
  EXPECT_EQ(result.mde_share, 0);
  EXPECT_EQ(result.truth.fps, 30);
  ASSERT_EQ(result.truth.trajectories.size(), 20U);
  for (std::size_t k = 0; k < 20; ++k) {
    const Trajectory& trajectory = result.truth.trajectories[k];
    EXPECT_EQ(trajectory.id, static_cast<Id>(k + 1));
    EXPECT_EQ(result.animals[k].id, trajectory.id);
    ASSERT_EQ(trajectory.points.size(), 30U);
    EXPECT_EQ(trajectory.points.front().frame, 1);
    EXPECT_EQ(trajectory.points.back().frame, 30);
  }
}

TEST(SimulateScene, VelocitiesAreThePathsOwn) {
  const SceneResult result = SimulateScene(SmallScene(), {}, {});
  for (const Trajectory& trajectory : result.truth.trajectories) {
    for (std::size_t k = 1; k + 1 < trajectory.points.size(); ++k) {
      const Vec3d difference =
          15.0 * (trajectory.points[k + 1].position - trajectory.points[k - 1].position);
      EXPECT_LT(Norm(trajectory.points[k].velocity - difference), 0.5);
    }
  }
}

TEST(SimulateScene, BodiesPointAlongTheFlightAndBankIntoTheTurn) {
  Scene scene = SmallScene();
  scene.species[0].count = 1;
  scene.species[0].model.parameters = {{"noise", 0}, {"alpha_b", 0}, {"level", 5}};
  scene.goals = {{.species = "", .position = {0, 0, 12}, .weight = 1}};
  scene.warmup = 10;
  const SceneResult result = SimulateScene(scene, {}, {});
  for (std::size_t k = 1; k < 29; ++k) {
    const TrajectoryPoint& point = result.truth.trajectories[0].points[k];
    const Rotation3d world_from_body = RotationFromQuaternion(point.world_from_body);
    const Vec3d forward = world_from_body * Vec3d{1, 0, 0};
    const Vec3d up = world_from_body * Vec3d{0, 0, 1};
    EXPECT_NEAR(Dot(forward, Normalized(point.velocity)), 1, 1e-6);
    // It circles the goal: its back leans inwards by atan(a / g).
    const Vec3d inwards = Normalized(Vec3d{0, 0, 12} - point.position);
    const Vec3d a = 15.0 * (result.truth.trajectories[0].points[k + 1].velocity -
                            result.truth.trajectories[0].points[k - 1].velocity);
    EXPECT_GT(Dot(up, inwards), 0.2);
    EXPECT_NEAR(std::atan2(Dot(up, inwards), up.z), std::atan2(Dot(a, inwards), 9.81), 0.15);
  }
}

TEST(SimulateScene, SameBytesAtAnyThreadCountOtherSeedOtherPath) {
  Scene scene = SmallScene();
  const auto last = [&scene](int threads) {
    return SimulateScene(scene, {.threads = threads}, {})
        .truth.trajectories[7]
        .points.back()
        .position;
  };
  const Vec3d one = last(1);
  EXPECT_EQ(last(2), one);
  ++scene.seed;
  EXPECT_NE(last(1), one);
}

TEST(SimulateScene, ReportsProgress) {
  std::int64_t calls = 0, last = 0, whole = 0;
  SimulateScene(SmallScene(), {}, [&](std::int64_t done, std::int64_t total) {
    ++calls;
    EXPECT_GE(done, last);
    last = done;
    whole = total;
  });
  EXPECT_GT(calls, 10);
  EXPECT_EQ(last, whole);
}

// Every scene of the project, as a user starts it.
class SceneFile : public ::testing::TestWithParam<const char*> {};

TEST_P(SceneFile, StaysInViewAndMoves) {
  const Scene scene =
      ReadScene(std::string(FLOCKLIFT_SOURCE_DIR) + "/data_synthetic/" + GetParam() + ".toml");
  const SceneResult result = SimulateScene(scene, {}, {});
  const bool pixels = scene.dimensions == 2;
  for (const Trajectory& trajectory : result.truth.trajectories) {
    EXPECT_EQ(trajectory.points.size(), static_cast<std::size_t>(scene.FrameCount()));
    double fastest = 0, furthest = 0;
    for (const TrajectoryPoint& point : trajectory.points) {
      EXPECT_TRUE(std::isfinite(Norm(point.position) + Norm(point.velocity)));
      fastest = std::max(fastest, Norm(point.velocity));
      furthest = std::max(furthest, Norm(point.position));
    }
    EXPECT_GT(fastest, pixels ? 100 : 5);
    EXPECT_LT(fastest, pixels ? 301 : 16);
    EXPECT_LT(furthest, pixels ? 2500 : 120);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SceneFile,
                         ::testing::Values("demo", "boids3d", "boids2d", "predator", "lin",
                                           "transit"));

// The scenes of other models, whatever their scale: everybody stays near the box, moves, and keeps
// to the model's highest speed.
class ModelScene : public ::testing::TestWithParam<const char*> {};

TEST_P(ModelScene, StaysNearItsBoxAndMoves) {
  Scene scene =
      ReadScene(std::string(FLOCKLIFT_SOURCE_DIR) + "/data_synthetic/" + GetParam() + ".toml");
  scene.duration = std::min(scene.duration, 3.0);
  const SceneResult result = SimulateScene(scene, {}, {});
  const Vec3d margin = 0.25 * (scene.box.high - scene.box.low);
  const double limit = scene.species.front().speed;
  for (const Trajectory& trajectory : result.truth.trajectories) {
    double fastest = 0;
    for (const TrajectoryPoint& point : trajectory.points) {
      const Vec3d low = point.position - scene.box.low + margin;
      const Vec3d high = scene.box.high + margin - point.position;
      EXPECT_GT(std::min({low.x, low.y, low.z, high.x, high.y, high.z}), 0);
      fastest = std::max(fastest, Norm(point.velocity));
    }
    EXPECT_GT(fastest, 0.1 * limit);
    EXPECT_LT(fastest, 4 * limit);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ModelScene,
                         ::testing::Values("opensteer", "glass_box", "mating", "village_migration",
                                           "escape", "phase_transition", "crowd"));

// What the demo promises to the reconstruction: the mean speed given as a prior is the flock's own,
// and the flock stays where the camera sees it.
TEST(Demo, MeanSpeedDepthsAndView) {
  const Scene scene = ReadScene(std::string(FLOCKLIFT_SOURCE_DIR) + "/data_synthetic/demo.toml");
  const SceneResult result = SimulateScene(scene, {}, {});
  const Rigid3d cam_from_world = LookAt(scene.camera.position, scene.camera.look_at);
  const double half_width = std::tan(0.5 * scene.camera.fov_deg * std::acos(-1.0) / 180);
  double speed = 0, rows = 0, in_view = 0;
  for (const Trajectory& trajectory : result.truth.trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) {
      const Vec3d p = cam_from_world * point.position;
      ++rows;
      speed += Norm(point.velocity);
      in_view += std::abs(p.x / p.z) < half_width && std::abs(p.y / p.z) < half_width * 1080 / 1920;
      EXPECT_GT(p.z, 24);
      EXPECT_LT(p.z, 69);
    }
  }
  EXPECT_NEAR(speed / rows, scene.species[0].speed, 0.02 * scene.species[0].speed);
  EXPECT_GT(in_view / rows, 0.97);
}

}  // namespace
}  // namespace flocklift
