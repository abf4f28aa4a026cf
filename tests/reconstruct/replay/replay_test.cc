// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/replay/replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/flock/simulate_scene.h"
#include "tests/reconstruct/fit/scene_flocks.h"

namespace flocklift {
namespace {

constexpr double kFps = 30;

Parameters By(const ModelSpec& model, const std::optional<Region>& walls = {}) {
  Parameters parameters;
  parameters.model = model;
  parameters.walls = walls;
  return parameters;
}

// Boids among themselves, no walls near, no goals, neither noise nor cruising speeds: what a replay
// can repeat exactly.
Scene OpenSkyScene() {
  Scene scene;
  scene.duration = 3;
  scene.fps = kFps;
  scene.box = {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}};
  SpeciesSpec species;
  species.count = 12;
  species.speed_spread = 0;
  species.start = Region{{-6, -6, -3}, {6, 6, 3}};
  species.model.parameters = {{"noise", 0}, {"cruise", 0}};
  scene.species = {species};
  return scene;
}

TEST(Replay, OfATrueFlockByItsOwnModelStaysWithIt) {
  const Scene scene = OpenSkyScene();
  const Trajectories truth = SimulateScene(scene, {}, {}).truth;
  ReplayOptions options;
  options.frame = 1;
  options.substeps = scene.substeps;
  const ReplayResult result = Replay(options, By(scene.species[0].model), truth, kFps, 1, 1);
  ASSERT_EQ(result.divergence.size(), 89U);
  const Divergence& end = result.divergence.back();
  EXPECT_EQ(end.animals, 12);
  EXPECT_NEAR(end.time, 89 / kFps, 1e-9);
  EXPECT_GT(end.straight_on_rms, 0.5);  // they did turn
  EXPECT_LT(end.model_rms, 0.01 * end.straight_on_rms);
}

TEST(Replay, ByAnotherModelParts) {
  const Scene scene = OpenSkyScene();
  const Trajectories truth = SimulateScene(scene, {}, {}).truth;
  ModelSpec wrong = scene.species[0].model;
  wrong.parameters["alpha_c"] = 20;
  ReplayOptions options;
  options.frame = 1;
  const double right =
      Replay(options, By(scene.species[0].model), truth, kFps, 1, 1).divergence.back().model_rms;
  EXPECT_GT(Replay(options, By(wrong), truth, kFps, 1, 1).divergence.back().model_rms, 3 * right);
}

// Two animals straight on and never near each other: no model moves them from their line.
Trajectories Pair() {
  Trajectories pair;
  for (const Id id : {4, 9}) {
    Trajectory trajectory{.id = id, .points = {}};
    for (int frame = 3; frame <= 20; ++frame) {
      TrajectoryPoint point;
      point.frame = frame;
      point.position = {10.0 * frame / kFps, 1000.0 * static_cast<double>(id), 5};
      trajectory.points.push_back(point);
    }
    pair.trajectories.push_back(trajectory);
  }
  pair.trajectories[1].points.pop_back();  // the second one leaves earlier
  ComputeVelocities(kFps, &pair);
  return pair;
}

TEST(Replay, StartsWhereMostIsStillToCome) {
  Trajectories flock = Pair();
  Trajectory late = flock.trajectories[0];
  late.id = 10;
  for (TrajectoryPoint& point : late.points) {
    point.position.y = -1000;
    point.frame += 15;  // three animals from frame 18 on, two before
  }
  flock.trajectories.push_back(late);
  const ModelSpec boids{.name = "boids", .parameters = {}, .where = {}, .where_of = {}};
  EXPECT_EQ(Replay({}, By(boids), flock, kFps, 1, 1).start_frame, 3);
  const ReplayOptions one_frame{.duration = 1 / kFps};
  EXPECT_EQ(Replay(one_frame, By(boids), flock, kFps, 1, 1).start_frame, 18);
  std::erase_if(flock.trajectories[0].points, [](const auto& p) { return p.frame < 18; });
  std::erase_if(flock.trajectories[1].points, [](const auto& p) { return p.frame > 5; });
  EXPECT_EQ(Replay({}, By(boids), flock, kFps, 1, 1).start_frame, 18);
}

TEST(Replay, KeepsFramesAndIds) {
  const ReplayResult result = Replay(
      {}, By({.name = "boids", .parameters = {}, .where = {}, .where_of = {}}), Pair(), kFps, 1, 1);
  EXPECT_EQ(result.start_frame, 3);
  ASSERT_EQ(result.replayed.trajectories.size(), 2U);
  EXPECT_EQ(result.replayed.trajectories[0].id, 4);
  EXPECT_EQ(result.replayed.trajectories[1].id, 9);
  EXPECT_EQ(result.replayed.trajectories[1].points.front().frame, 3);
  EXPECT_EQ(result.replayed.trajectories[1].points.back().frame, 20);
  EXPECT_EQ(result.divergence.back().animals, 1);  // the other one had left
  EXPECT_NEAR(result.divergence.back().straight_on_rms, 0, 1e-6);
}

TEST(Replay, MoreAnimalsAreCopiesWithNewIdsAndTheSameAtAnyThreadCount) {
  ReplayOptions options;
  options.count = 50;
  const ModelSpec boids{.name = "boids", .parameters = {}, .where = {}, .where_of = {}};
  const ReplayResult one = Replay(options, By(boids), Pair(), kFps, 7, 1);
  const ReplayResult two = Replay(options, By(boids), Pair(), kFps, 7, 2);
  ASSERT_EQ(one.replayed.trajectories.size(), 50U);
  EXPECT_EQ(one.replayed.trajectories[2].id, 10);
  for (std::size_t k = 0; k < 50; ++k) {
    EXPECT_EQ(one.replayed.trajectories[k].points.back().position,
              two.replayed.trajectories[k].points.back().position);
  }
}

TEST(Replay, WithoutPullTheGuidedFlightIsTheEngines) {
  // The double-precision terms of the guided flight and the engine's kernels: one model.
  const Scene scene = OpenSkyScene();
  const Trajectories truth = SimulateScene(scene, {}, {}).truth;
  ReplayOptions options;
  options.frame = 1;
  options.duration = 1;
  const ReplayResult engine = Replay(options, By(scene.species[0].model), truth, kFps, 1, 1);
  options.alpha = 1 - 1e-12;
  const ReplayResult guided = Replay(options, By(scene.species[0].model), truth, kFps, 1, 1);
  for (std::size_t k = 0; k < 12; ++k) {
    const Vec3d apart = guided.replayed.trajectories[k].points.back().position -
                        engine.replayed.trajectories[k].points.back().position;
    EXPECT_LT(Norm(apart), 1e-3);
  }
}

TEST(Replay, ThePullKeepsAForeignModelOnThePath) {
  const Scene scene = OpenSkyScene();
  const Trajectories truth = SimulateScene(scene, {}, {}).truth;
  ModelSpec wrong = scene.species[0].model;
  wrong.parameters["alpha_c"] = 3;
  ReplayOptions options;
  options.frame = 1;
  double before = 1e9;
  for (const double alpha : {1.0, 0.9, 0.5, 0.0}) {
    options.alpha = alpha;
    const double apart = Replay(options, By(wrong), truth, kFps, 1, 1).divergence.back().model_rms;
    EXPECT_LT(apart, before) << alpha;
    before = apart;
  }
  EXPECT_LT(before, 0.3);
}

TEST(Replay, CopiesAreGuidedBesideTheirSource) {
  ReplayOptions options;
  options.count = 6;
  options.alpha = 0.2;
  const ModelSpec boids{
      .name = "boids", .parameters = {{"alpha_s", 0}}, .where = {}, .where_of = {}};
  const Trajectories pair = Pair();
  const ReplayResult result = Replay(options, By(boids), pair, kFps, 7, 1);
  for (const Trajectory& copy : result.replayed.trajectories) {
    const double moved = copy.points.back().position.x - copy.points.front().position.x;
    EXPECT_NEAR(moved, 10.0 * 17 / kFps, 0.5) << copy.id;
  }
}

TEST(Replay, APerturbationIsFollowed) {
  const Scene scene = OpenSkyScene();
  const Trajectories truth = SimulateScene(scene, {}, {}).truth;
  ReplayOptions options;
  options.frame = 1;
  const ReplayResult result = Replay(options, By(scene.species[0].model), truth, kFps, 1, 1);
  const double first = result.divergence.front().perturbed_rms;
  EXPECT_NEAR(first, std::sqrt(3.0) * kPerturbation, 0.5 * kPerturbation);
  EXPECT_GT(result.divergence.back().perturbed_rms, 0);
}

TEST(Replay, AGoalDrawsTheFlockFreeOrGuided) {
  Parameters parameters = By({.name = "boids",
                              .parameters = {{"noise", 0}, {"alpha_c", 0}, {"cruise", 0}},
                              .where = {},
                              .where_of = {}});
  for (const double alpha : {1.0, 0.999}) {
    ReplayOptions options;
    options.duration = 1;
    options.alpha = alpha;
    parameters.goals.clear();
    const double before = Replay(options, parameters, Pair(), kFps, 1, 1)
                              .replayed.trajectories[0]
                              .points.back()
                              .position.z;
    GoalSpec goal;
    goal.position = {5, 4000, 1000};
    parameters.goals = {goal};
    const double after = Replay(options, parameters, Pair(), kFps, 1, 1)
                             .replayed.trajectories[0]
                             .points.back()
                             .position.z;
    EXPECT_GT(after, before + 1) << alpha;  // 15 m/s^2 at most, and damped
  }
}

TEST(Replay, WithoutItsNoiseAModelPartsLater) {
  Scene scene = OpenSkyScene();
  scene.species[0].model.parameters["noise"] = 3;
  scene.species[0].model.parameters["noise_time"] = 0.5;
  const Trajectories truth = SimulateScene(scene, {}, {}).truth;
  ReplayOptions options;
  options.frame = 1;
  // Another seed: the replay's gusts are not the truth's.
  const Divergence end =
      Replay(options, By(scene.species[0].model), truth, kFps, 77, 1).divergence.back();
  EXPECT_LT(end.noiseless_rms, 0.9 * end.model_rms);
  EXPECT_GT(end.noiseless_rms, 0);
  options.noiseless = true;
  const Divergence expected =
      Replay(options, By(scene.species[0].model), truth, kFps, 78, 1).divergence.back();
  EXPECT_EQ(expected.model_rms, end.noiseless_rms);
  options.noiseless = false;
  // A model that has none is its own.
  const Scene calm = OpenSkyScene();
  const Divergence same =
      Replay(options, By(calm.species[0].model), SimulateScene(calm, {}, {}).truth, kFps, 77, 1)
          .divergence.back();
  EXPECT_EQ(same.noiseless_rms, same.model_rms);
}

TEST(Replay, WallsHoldTheFlock) {
  const ModelSpec boids{.name = "boids",
                        .parameters = {{"s_min", 0}, {"cruise", 0}, {"noise", 0}},
                        .where = {},
                        .where_of = {}};
  const Region walls{{-1e6, -1e6, -1e6}, {12, 1e6, 1e6}};
  ReplayOptions options;
  options.duration = 4;
  const auto furthest = [&](const std::optional<Region>& box) {
    double x = -1e9;
    for (const Trajectory& t :
         Replay(options, By(boids, box), Pair(), kFps, 1, 1).replayed.trajectories) {
      for (const TrajectoryPoint& point : t.points) x = std::max(x, point.position.x);
    }
    return x;
  };
  EXPECT_GT(furthest({}), 30);
  EXPECT_LT(furthest(walls), 25);
}

// Pair() flies along x at some 10 m/s: into a block in its way, or not.
TEST(Replay, ObstaclesAreAvoidedByModelsThatSeeThem) {
  const ModelSpec bswarm{.name = "bswarm",
                         .parameters = {{"s_max", 20},
                                        {"curl_gain", 0},
                                        {"sight", 5},
                                        {"horizon", 1},
                                        {"drive", 0},
                                        {"w_rep", 0},
                                        {"w_ali", 0},
                                        {"w_att", 0}},
                         .where = {},
                         .where_of = {}};
  ObstacleSpec block;
  block.box = Region{{12, 0, -500}, {14, 20000, 500}};
  ReplayOptions options;
  options.duration = 4;
  const auto furthest = [&](const std::vector<ObstacleSpec>& obstacles) {
    double x = -1e9;
    for (const Trajectory& t :
         Replay(options, By(bswarm), Pair(), kFps, 1, 1, {}, obstacles).replayed.trajectories) {
      for (const TrajectoryPoint& point : t.points) x = std::max(x, point.position.x);
    }
    return x;
  };
  EXPECT_GT(furthest({}), 20);
  EXPECT_LT(furthest({block}), 12.01);
  const ModelSpec boids{.name = "boids", .parameters = {}, .where = {}, .where_of = {}};
  EXPECT_THROW(Replay(options, By(boids), Pair(), kFps, 1, 1, {}, {block}), InputError);
  options.alpha = 0.5;
  EXPECT_THROW(Replay(options, By(bswarm), Pair(), kFps, 1, 1, {}, {block}), std::invalid_argument);
}

TEST(Replay, RefusesAFrameWithoutAnimals) {
  ReplayOptions options;
  options.frame = 1;
  const ModelSpec boids{.name = "boids", .parameters = {}, .where = {}, .where_of = {}};
  EXPECT_THROW(Replay(options, By(boids), Pair(), kFps, 1, 1), std::invalid_argument);
}

// A flock of the scene, flown on within it by its own numbers and another seed.
ReplayResult InScene(const Scene& scene, int frame) {
  const SpeciesSpec& species = scene.species[0];
  Parameters parameters = By(species.model);
  for (const ModelSpec& force : species.forces) parameters.model.terms.push_back(force);
  ReplayOptions options;
  options.frame = frame;
  return Replay(options, parameters, Fly(scene), scene.fps, scene.seed + 1, 1, {}, {}, scene);
}

TEST(Replay, FliesToWhatASceneHolds) {
  for (const Scene& scene : {ShapeScene(), CrowdScene(), MorphScene()}) {
    const ReplayResult result = InScene(scene, 8);
    ASSERT_FALSE(result.divergence.empty());
    const Divergence& end = result.divergence.back();
    EXPECT_EQ(end.animals, scene.species[0].count);
    EXPECT_LT(end.model_rms, 0.7 * end.straight_on_rms) << scene.species[0].model.name;
  }
}

// In mid-flight a swarm goes on to the places that were settled where it was first seen; by paths
// that begin later it is as if it started there.
TEST(Replay, ASwarmOnItsWayKeepsItsPlacesOnTheShape) {
  Scene scene = ShapeScene();
  scene.warmup = 0;
  scene.duration = 6;
  scene.species[0].count = 3000;
  scene.species[0].start = Region{{-9, -3, 6}, {-3, 3, 20}};
  scene.species[0].model.parameters = {};
  scene.shapes = {Shape("star", "moon.ply", {0, 0, 13}, 10)};
  const Trajectories truth = SimulateScene(scene, {}, {}).truth;
  ReplayOptions options;
  options.frame = 46;
  options.duration = 1;
  const auto end = [&](const Trajectories& seen) {
    const ReplayResult result = Replay(options, By(scene.species[0].model), seen, scene.fps,
                                       scene.seed + 1, 2, {}, {}, scene);
    return result.divergence.back();
  };
  Trajectories later = truth;
  for (Trajectory& path : later.trajectories) {
    std::erase_if(path.points, [](const TrajectoryPoint& point) { return point.frame < 46; });
  }
  const Divergence whole = end(truth), anew = end(later);
  EXPECT_LT(whole.model_rms, 0.6 * anew.model_rms);
  EXPECT_LT(whole.model_rms, whole.straight_on_rms);
}

// Along a path it goes on where it is, not where the path begins, with everybody near his place.
TEST(Replay, ASwarmThatHasArrivedStaysOnItsShape) {
  Scene scene = ShapeScene();
  scene.warmup = 0;
  scene.duration = 6;
  PathSpec& path = scene.paths.emplace_back();
  path.name = "way";
  path.points = {{0, 0, 0}, {1, 0.2, 0}, {2, 0.2, 0}, {3, 0, 0}};
  path.speed = 0.3;
  scene.species[0].path = path.name;
  const Divergence end = InScene(scene, 46).divergence.back();
  EXPECT_GT(end.time, 2.5);
  EXPECT_LT(end.model_rms, 0.5 * end.straight_on_rms);
}

TEST(Replay, TheForcesOfASceneFeelItsWind) {
  Scene scene = OpenSkyScene();
  scene.wind.velocity = {0, 0, 12};
  SpeciesSpec& birds = scene.species[0];
  birds.model = {.name = "forces", .parameters = {{"s_max", 50}}, .where = {}, .where_of = {}};
  birds.forces = {{.name = "wind", .parameters = {{"rate", 0.5}}, .where = {}, .where_of = {}},
                  {.name = "noise", .parameters = {{"sd", 1}}, .where = {}, .where_of = {}}};
  const Divergence end = InScene(scene, 1).divergence.back();
  EXPECT_LT(end.noiseless_rms, 0.3 * end.straight_on_rms);
  EXPECT_LT(end.noiseless_rms, end.model_rms);
  Parameters parameters = By(birds.model);
  parameters.model.terms = birds.forces;
  const Trajectories truth = Fly(scene);
  EXPECT_THROW(Replay({}, parameters, truth, kFps, 1, 1), InputError);  // no wind is known
  ReplayOptions guided;
  guided.frame = 1;
  guided.alpha = 0.95;
  EXPECT_LT(
      Replay(guided, parameters, truth, kFps, 1, 1, {}, {}, scene).divergence.back().model_rms,
      0.3 * end.straight_on_rms);
}

}  // namespace
}  // namespace flocklift
