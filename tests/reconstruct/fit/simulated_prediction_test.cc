// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/simulated_prediction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reconstruct/fit/departure.h"
#include "reconstruct/fit/expected_field.h"
#include "reconstruct/fit/held_out.h"
#include "simulate/core/check.h"
#include "simulate/fields/curl_noise.h"
#include "tests/reconstruct/fit/scene_flocks.h"

namespace flocklift {
namespace {

TEST(HeldOut, IsTheLastShareOfTheTime) {
  Trajectories flock;
  for (int k = 0; k < 2; ++k) {
    flock.trajectories.push_back({.id = k + 1, .points = {}});
    for (int f = 1 + 8 * k; f <= 10; ++f) {
      TrajectoryPoint point;
      point.frame = f;
      flock.trajectories.back().points.push_back(point);
    }
  }
  EXPECT_EQ(FirstHeldOut(flock, 0.2), 9);
  const Trajectories early = BeforeFrame(flock, 9);
  ASSERT_EQ(early.trajectories.size(), 1U);  // the second came in frame 9
  EXPECT_EQ(early.trajectories[0].points.size(), 8U);
}

TEST(ExpectedField, IsTheNoiseBetweenThoseWhoFeltIt) {
  const NoiseTerm<double> term{0.4, 1.5, 6};
  Rng rng(3);
  const auto inside = [&rng] {
    return Vec3d{rng.Uniform(-1.5, 1.5), rng.Uniform(-1.5, 1.5), rng.Uniform(1, 4)};
  };
  VelocitySample seen;
  for (int k = 0; k < 150; ++k) {
    seen.position.push_back(inside());
    seen.velocity.push_back(CurlNoise(term, seen.position.back()));
  }
  std::vector<Vec3d> unseen;
  for (int k = 0; k < 50; ++k) unseen.push_back(inside());
  const ExpectedField field(seen, 1.5, 1e8);
  const std::vector<Vec3d> at_seen = field.At(seen.position), elsewhere = field.At(unseen);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    EXPECT_LT(Norm(at_seen[k] - seen.velocity[k]), 1e-3);
  }
  double off = 0, all = 0;
  for (std::size_t k = 0; k < unseen.size(); ++k) {
    const Vec3d truth = CurlNoise(term, unseen[k]);
    off += SquaredNorm(elsewhere[k] - truth);
    all += SquaredNorm(truth);
  }
  EXPECT_LT(off, 0.1 * all);
  EXPECT_EQ(field.At(std::vector<Vec3d>{{90, 90, 90}})[0], Vec3d{});  // nobody was there
}

// Flies in a box that bswarm's zones and walls turn round.
Scene FliesScene() {
  Scene scene;
  scene.seed = 5;
  scene.fps = 20;
  scene.substeps = 1;
  scene.duration = 5;
  scene.warmup = 2;
  scene.box = {{-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5}};
  SpeciesSpec flies;
  flies.count = 25;
  flies.speed = 0.3;
  flies.model.name = "bswarm";
  flies.model.parameters = {{"r_rep", 0.08}, {"r_ali", 0.2}, {"r_att", 0.5},     {"w_rep", 1},
                            {"w_ali", 0.2},  {"w_att", 0.3}, {"curl_gain", 0},   {"noise", 0.3},
                            {"alpha_b", 12}, {"drive", 2},   {"wall_taper", 0.1}};
  flies.model.choices["avoid"] = "none";
  scene.species = {flies};
  return scene;
}

FitOptions Quick() {
  FitOptions options;
  options.substeps = 1;
  options.statistics_time = 1;
  options.global_evaluations = 150;
  options.local_evaluations = 6;
  options.noise_animals = 70;
  return options;
}

TEST(SimulatedPrediction, BswarmForeseesWhatZonesAndWallsDo) {
  const Scene scene = FliesScene();
  const Trajectories flock = Fly(scene);
  FitProblem problem;
  problem.model = scene.species[0].model;
  problem.free = {"w_att"};
  problem.walls = scene.box;
  problem.search = SimulatedSearch::kBobyqa;
  const SimulatedPrediction one = PredictBySimulation(Quick(), problem, flock, 20, 1, 1);
  const SimulatedPrediction two = PredictBySimulation(Quick(), problem, flock, 20, 1, 2);
  ASSERT_TRUE(one.r2.has_value());
  EXPECT_GT(*one.r2, 0.2);
  EXPECT_LE(*one.r2, 1);
  EXPECT_EQ(*one.r2, *two.r2);
  // The same flies with walls that are elsewhere, and no zones.
  problem.walls = Region{{-5, -5, -5}, {5, 5, 5}};
  problem.model.parameters["w_rep"] = problem.model.parameters["w_ali"] = 0.001;
  problem.model.parameters["w_att"] = 0.001;
  const SimulatedPrediction off = PredictBySimulation(Quick(), problem, flock, 20, 1, 2);
  ASSERT_TRUE(off.r2.has_value());
  EXPECT_LT(*off.r2, *one.r2 - 0.1);
}

TEST(SimulatedPrediction, ASwarmDriftsInTheFieldThatWasSeen) {
  for (const double evolution : {0.0, 4.0}) {
    Scene scene;
    scene.seed = 8;
    scene.fps = 30;
    scene.substeps = 1;
    scene.duration = 1.5;
    scene.box = {{-9, -9, -9}, {9, 9, 9}};
    SpeciesSpec midges;
    midges.count = 90;
    midges.start = Region{{-1.5, -1.5, 1}, {1.5, 1.5, 4}};
    midges.model.name = "swarm";
    midges.model.parameters = {
        {"scale", 1.5}, {"gain", 0.4}, {"evolution", evolution}, {"d_min", 0}};
    scene.species = {midges};
    FitProblem problem;
    problem.model.name = "swarm";
    problem.model.parameters["evolution"] = evolution;
    const SimulatedPrediction prediction =
        PredictBySimulation(Quick(), problem, Fly(scene), 30, 1, 2);
    ASSERT_TRUE(prediction.r2.has_value());
    EXPECT_GT(*prediction.r2, evolution > 0 ? 0.3 : 0.6) << evolution;
  }
}

SimulatedPrediction PredictInScene(const Scene& scene, const std::string& free) {
  FitProblem problem = ProblemOf(scene);
  problem.free = {free};
  problem.search = SimulatedSearch::kBobyqa;
  return PredictBySimulation(Quick(), problem, Fly(scene), scene.fps, 1, 2);
}

// Straight on is 0.
TEST(SimulatedPrediction, ForeseesWhatAScenesTargetsDo) {
  const SimulatedPrediction shape = PredictInScene(ShapeScene(), "alpha");
  const SimulatedPrediction crowd = PredictInScene(CrowdScene(), "f_max");
  const SimulatedPrediction morph = PredictInScene(MorphScene(), "speed0");
  EXPECT_GT(shape.r2.value(), 0.5);
  EXPECT_GT(crowd.r2.value(), 0.2);
  EXPECT_GT(morph.r2.value(), 0.5);
}

ModelSpec Named(const char* name) {
  return {.name = name, .parameters = {}, .where = {}, .where_of = {}};
}

TEST(SimulatedPrediction, SaysWhyAModelCannotBeFlown) {
  EXPECT_TRUE(WhyNoDeparture(Named("bswarm")).empty());
  for (const char* const name : {"shape", "morph", "crowd", "forces"}) {
    EXPECT_FALSE(WhyNoDeparture(Named(name)).empty());
    FitProblem problem;
    problem.model.name = name;
    EXPECT_THROW(PredictBySimulation({}, problem, Fly(FliesScene()), 20, 1, 1), InputError);
  }
}

}  // namespace
}  // namespace flocklift
