// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/window_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reconstruct/fit/depth_noise.h"
#include "tests/reconstruct/fit/flocks.h"

namespace flocklift {
namespace {

// Birds that nothing moves fly straight on, by the model too.
TEST(FlyOn, OfFreeFlightHasNoError) {
  Trajectories flock;
  flock.fps = 10;
  for (int id = 1; id <= 3; ++id) {
    flock.trajectories.push_back({.id = id, .points = {}});
    for (int frame = 1; frame <= 40; ++frame) {
      TrajectoryPoint point;
      point.frame = frame;
      point.position = {0.5 * frame, 100.0 * id, 50};
      flock.trajectories.back().points.push_back(point);
    }
  }
  Parameters parameters;
  parameters.model.name = "linear";
  parameters.model.parameters = {{"cohesion", 0}, {"alignment", 0}, {"diffusion", 9}};
  const internal::FlownErrors free = internal::FlyOn(parameters, flock, 10, 4, 1);
  EXPECT_LT(free.model, 1e-3);
  EXPECT_LT(free.straight_on, 1e-9);
  parameters.model.parameters["cohesion"] = 0.1;
  EXPECT_GT(internal::FlyOn(parameters, flock, 10, 4, 1).model, 1);
}

// With slow depth errors, the model over the window that is chosen flies no worse than over that
// which the positions' noise chooses; without them, or by another method, there is no choice.
TEST(WindowChoice, FliesNoWorse) {
  Scene scene = BoidsScene(4);
  scene.duration = 4;
  scene.species[0].count = 12;
  Trajectories flock = Fly(scene);
  for (Trajectory& path : flock.trajectories) {
    for (TrajectoryPoint& point : path.points) {
      point.position += Vec3d{0, 50, 0};
      point.sd_depth = 1;
    }
  }
  flock.has_sd_depth = true;
  const Trajectories seen =
      AddDepthNoise({.time = 2, .scale_sd = 0, .seed = 3, .draw = 0}, {}, scene.fps, flock);
  FitProblem problem;
  problem.model.name = "boids";
  problem.model.parameters["d_s"] = 2;
  FitOptions options;
  options.depth_draws = 0;
  const int chosen = internal::ChooseWindowByFlight(options, {.problem = problem, .notes = {}},
                                                    seen, scene.fps, 1, 1);
  ASSERT_GT(chosen, 0);
  const FitResult by_flight = FitModel(options, problem, seen, scene.fps, 1, 1);
  EXPECT_EQ(by_flight.window, chosen);
  Trajectories unsaid = seen;
  unsaid.has_sd_depth = false;  // so that the window is that of the noise
  FitOptions named = options;
  named.window = FitModel(options, problem, unsaid, scene.fps, 1, 1).window;
  const FitResult by_noise = FitModel(named, problem, seen, scene.fps, 1, 1);
  const auto error = [&](const FitResult& fit) {
    return internal::FlyOn(fit.parameters, seen, scene.fps, 4, 1).model;
  };
  EXPECT_LE(error(by_flight), error(by_noise));
}

}  // namespace
}  // namespace flocklift
