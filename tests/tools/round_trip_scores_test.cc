// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/round_trip_scores.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulate/camera/projection.h"
#include "simulate/core/rigid3.h"
#include "simulate/flock/simulate_scene.h"
#include "tools/round_trip_table.h"

namespace flocklift {
namespace {

constexpr double kFps = 30;

// Boids in an open sky without noise, before a camera that sees them all.
class RoundTripScoresTest : public testing::Test {
 protected:
  RoundTripScoresTest() {
    Scene scene;
    scene.duration = 3;
    scene.fps = kFps;
    scene.box = {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}};
    SpeciesSpec species;
    species.count = 10;
    species.speed_spread = 0;
    species.start = Region{{-6, -6, -3}, {6, 6, 3}};
    species.model.parameters = {{"noise", 0}, {"cruise", 0}};
    scene.species = {species};
    truth_ = SimulateScene(scene, {}, {}).truth;
    right_.model = species.model;
    wrong_ = right_;
    wrong_.model.parameters["alpha_c"] = 20;
    camera_.width = 2000;
    camera_.height = 2000;
    camera_.intrinsics = {.fx = 1000, .fy = 1000, .cx = 999.5, .cy = 999.5};
    camera_.cam_from_world = LookAt({0, -60, 0}, {0, 0, 0});
    replay_.substeps = scene.substeps;
  }

  // Under other ids, and all moved by `error`.
  RoundTripLeg Seen(const std::string& stage, const Vec3d& error) const {
    RoundTripLeg leg{.stage = stage, .paths = truth_, .parameters = right_, .has_true_ids = false};
    for (Trajectory& path : leg.paths.trajectories) {
      path.id += 100;
      for (TrajectoryPoint& point : path.points) point.position += error;
    }
    return leg;
  }
  RoundTripScores Score(const std::vector<RoundTripLeg>& legs, int threads = 1,
                        const FilmAgain& film = {}) const {
    return ScoreRoundTrip({.lead = 0.5, .starts = 3}, replay_, camera_, truth_, legs, kFps, 1,
                          threads, film);
  }

  Trajectories truth_;
  Parameters right_, wrong_;
  Camera camera_;
  ReplayOptions replay_;
};

TEST_F(RoundTripScoresTest, TheStageThatErrsHasTheShare) {
  // A shift of the whole flock along the line of sight is flown on unchanged.
  const RoundTripLeg shifted = Seen("reconstruct", {0, 3, 0});
  RoundTripLeg unfitted{.stage = "fit", .paths = truth_, .parameters = wrong_};
  const RoundTripLeg exact{.stage = "replay", .paths = truth_, .parameters = right_};

  const RoundTripScores depth = Score({shifted, exact});
  EXPECT_EQ(depth.animals, 30);
  EXPECT_NEAR(depth.error, 3, 0.01);
  EXPECT_NEAR(depth.stages[0].share, 1, 1e-3);
  EXPECT_NEAR(depth.stages[1].share, 0, 1e-3);
  EXPECT_NEAR(*depth.stages[0].coverage, 1, 1e-12);
  EXPECT_NEAR(depth.stages[0].flock->neighbour, 0, 1e-3);  // a shift changes no distance

  const RoundTripScores force = Score({unfitted, exact});
  EXPECT_GT(force.stages[0].share, 0.99);
  EXPECT_GT(force.stages[0].flock->neighbour, 0.01);

  const RoundTripScores both = Score({Seen("track", {0, 3, 0}), unfitted, exact});
  EXPECT_NEAR(both.stages[0].share + both.stages[1].share + both.stages[2].share, 1, 1e-9);
  EXPECT_NEAR(*both.stages[1].error, force.error, 1e-9);
}

TEST_F(RoundTripScoresTest, TheSecondFilmErrsInThePictureAlone) {
  const RoundTripLeg exact{.stage = "replay", .paths = truth_, .parameters = right_};
  // What a tracker makes of the film: all boxes 3 px to the right, one animal missed.
  const FilmAgain film = [&](const Trajectories& flock) {
    Tracks tracks;
    for (std::size_t k = 1; k < flock.trajectories.size(); ++k) {
      Tracklet& tracklet = tracks.tracklets.emplace_back();
      tracklet.id = static_cast<Id>(k);
      for (const TrajectoryPoint& point : flock.trajectories[k].points) {
        const Vec2d at =
            Project(camera_.intrinsics, camera_.CamFromWorld(point.frame) * point.position);
        Detection seen;
        seen.frame = point.frame;
        seen.box = Box::Around({at.x + 3, at.y}, 8, 8);
        tracklet.detections.push_back(seen);
      }
    }
    return tracks;
  };
  const RoundTripScores scores = Score({exact}, 1, film);
  ASSERT_EQ(scores.stages.size(), 2U);
  EXPECT_EQ(scores.stages[1].stage, "film again");
  EXPECT_FALSE(scores.stages[1].error.has_value());
  EXPECT_NEAR(scores.stages[1].image_error, 3, 0.05);
  EXPECT_NEAR(*scores.stages[1].coverage, 0.9, 1e-12);
  EXPECT_GT(scores.stages[1].image_share, 0.9);
  EXPECT_NEAR(scores.stages[0].image_share + scores.stages[1].image_share, 1, 1e-12);
}

TEST_F(RoundTripScoresTest, AnimalsThatALegLacksCountInNone) {
  RoundTripLeg part{.stage = "track", .paths = truth_, .parameters = right_};
  part.paths.trajectories.pop_back();
  const RoundTripLeg exact{.stage = "replay", .paths = truth_, .parameters = right_};
  const RoundTripScores scores = Score({part, exact});
  EXPECT_EQ(scores.animals, 27);
  EXPECT_NEAR(*scores.stages[0].coverage, 0.9, 1e-12);
  EXPECT_NEAR(*scores.stages[1].coverage, 1, 1e-12);
}

TEST_F(RoundTripScoresTest, SameAtAnyThreadCountAndWrittenAsItIs) {
  const RoundTripLeg seen = Seen("film", {0.5, 3, 0});
  RoundTripLeg unfitted{.stage = "fit", .paths = truth_, .parameters = wrong_};
  const auto one = RoundTripAsJson(Score({seen, unfitted}, 1));
  EXPECT_EQ(one, RoundTripAsJson(Score({seen, unfitted}, 2)));
  EXPECT_EQ(one.at("stages").size(), 2U);
  const std::string table = RoundTripTable(one);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
  EXPECT_NE(table.find("| fit | 1.00 |"), std::string::npos) << table;
}

TEST_F(RoundTripScoresTest, AFilmShorterThanTheLeadIsRefused) {
  const RoundTripLeg exact{.stage = "replay", .paths = truth_, .parameters = right_};
  const auto score = [&](const RoundTripOptions& options, double fps) {
    ScoreRoundTrip(options, replay_, camera_, truth_, {exact}, fps, 1, 1);
  };
  EXPECT_THROW(score({.lead = 3}, kFps), std::invalid_argument);
  EXPECT_THROW(score({.lead = 1, .starts = 0}, kFps), std::invalid_argument);
  EXPECT_THROW(score({}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
