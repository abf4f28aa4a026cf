// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/metrics/trajectory_scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

TrajectoryPoint At(int frame, const Vec3d& position) {
  TrajectoryPoint point;
  point.frame = frame;
  point.position = position;
  return point;
}

// 1000 x 800 px, looking along the world's +y, image up = world +z.
Camera TestCamera() {
  Camera camera;
  camera.width = 1000;
  camera.height = 800;
  camera.intrinsics = {.fx = 1000, .fy = 1000, .cx = 499.5, .cy = 399.5};
  camera.cam_from_world = LookAt({0, -10, 2}, {0, 100, 2});
  return camera;
}

// Animals at depth 20, 25, 30 .. that cross the picture from left to right, frames 1 .. 20.
Trajectories Flock(int animals) {
  Trajectories flock;
  for (Id id = 1; id <= animals; ++id) {
    Trajectory trajectory{id, {}};
    for (int frame = 1; frame <= 20; ++frame) {
      const double y = 5 + 5.0 * static_cast<double>(id);
      trajectory.points.push_back(
          At(frame, {-5 + 0.5 * frame, y, 2 + 0.5 * static_cast<double>(id)}));
    }
    flock.trajectories.push_back(trajectory);
  }
  return flock;
}

// Every point moved along its ray: depth times `factor(id)`.
template <typename Factor>
Trajectories AlongRays(const Camera& camera, Trajectories flock, Factor factor) {
  for (Trajectory& trajectory : flock.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) {
      const Rigid3d cam_from_world = camera.CamFromWorld(point.frame);
      point.position = cam_from_world.Inverse() *
                       ((cam_from_world * point.position) * factor(trajectory.id, point.frame));
    }
  }
  return flock;
}

TrajectoryScores Score(const Trajectories& truth, const Trajectories& result,
                       std::optional<double> scale_sd = {}, bool by_image = false) {
  const auto scores = ScoreTrajectories(
      MatchTrajectories({.by_image = by_image}, TestCamera(), truth, result), scale_sd);
  EXPECT_TRUE(scores.has_value());
  return scores.value_or(TrajectoryScores{});
}

TEST(TrajectoryScores, PerfectResult) {
  const TrajectoryScores s = Score(Flock(6), Flock(6));
  EXPECT_EQ(s.rows, 120);
  EXPECT_DOUBLE_EQ(s.coverage, 1);
  EXPECT_DOUBLE_EQ(s.scale, 1);
  EXPECT_DOUBLE_EQ(s.error_median, 0);
  EXPECT_DOUBLE_EQ(*s.depth_spearman, 1);
  EXPECT_NEAR(*s.velocity_angle, 0, 1e-5);
  EXPECT_NEAR(s.extent, 25, 1e-12);  // depths 20 .. 45
  EXPECT_FALSE(s.within_1sd.has_value());
  // Median depth 32.5: |32.5 - z| / z at 20, 25, 30, 35, 40, 45.
  EXPECT_NEAR(s.constant_error_median, 0.5 * (7.5 / 40 + 12.5 / 45),
              1e-12);  // sorted: 30, 35, 40, 45, 25, 20
}

TEST(TrajectoryScores, TwiceAsFarIsOnlyAScale) {
  const TrajectoryScores s =
      Score(Flock(6), AlongRays(TestCamera(), Flock(6), [](Id, int) { return 2.0; }), 0.5);
  EXPECT_NEAR(s.error_median, 1, 1e-12);
  EXPECT_NEAR(s.scaled_error_p90, 0, 1e-12);
  EXPECT_NEAR(s.scale, 0.5, 1e-12);
  EXPECT_NEAR(s.skill, 1 / s.constant_error_median, 1e-9);
  EXPECT_FALSE(s.scale_z.has_value());  // no sd_depth, no calibration
}

TEST(TrajectoryScores, ReversedDepthsReverseTheOrder) {
  const Trajectories reversed = AlongRays(TestCamera(), Flock(6), [](Id id, int) {
    return (20 + 5.0 * static_cast<double>(6 - id)) / (15 + 5.0 * static_cast<double>(id));
  });
  EXPECT_DOUBLE_EQ(*Score(Flock(6), reversed).depth_spearman, -1);
}

TEST(TrajectoryScores, OneDepthForAllHasNoOrderAndNoSkill) {
  const Trajectories flat = AlongRays(TestCamera(), Flock(6), [](Id id, int) {
    return 32.5 / (15 + 5.0 * static_cast<double>(id));
  });
  const TrajectoryScores s = Score(Flock(6), flat);
  EXPECT_NEAR(s.skill, 1, 1e-9);
}

TEST(TrajectoryScores, VelocityAngle) {
  Trajectories result = Flock(6);
  for (Trajectory& trajectory : result.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) point.position.y += 0.5 * point.frame;
  }
  EXPECT_NEAR(*Score(Flock(6), result).velocity_angle, 45, 1e-9);
}

TEST(TrajectoryScores, CoverageCountsWhatIsMissing) {
  Trajectories result = Flock(6);
  result.trajectories.erase(result.trajectories.begin());
  result.trajectories[0].points.resize(10);
  EXPECT_NEAR(Score(Flock(6), result).coverage, 90.0 / 120, 1e-12);
}

TEST(TrajectoryScores, CoverageInViewCountsThePictureOnly) {
  Trajectories truth = Flock(2);
  for (TrajectoryPoint& point : truth.trajectories[1].points) point.position.x = 100;  // outside
  Trajectories result = truth;
  result.trajectories.pop_back();
  const TrajectoryScores s = Score(truth, result);
  EXPECT_NEAR(s.coverage, 0.5, 1e-12);
  EXPECT_NEAR(*s.coverage_in_view, 1, 1e-12);
}

TEST(TrajectoryScores, TruthBehindTheCameraIsNotMatched) {
  Trajectories truth = Flock(2);
  for (TrajectoryPoint& point : truth.trajectories[1].points) point.position.y = -50;
  EXPECT_EQ(Score(truth, truth).rows, 20);
}

TEST(TrajectoryScores, NothingInCommon) {
  Trajectories result = Flock(2);
  for (Trajectory& trajectory : result.trajectories) trajectory.id += 100;
  EXPECT_FALSE(
      ScoreTrajectories(MatchTrajectories({}, TestCamera(), Flock(2), result), {}).has_value());
}

// Gaussian errors of which sd_depth knows: a common scale (sd 10 %) and each point's own (sd 2 %).
TEST(TrajectoryScores, HonestDeviationsAreCalibrated) {
  const double kScaleSd = 0.1, kOwnSd = 0.02;
  int within = 0, seeds = 400;
  double z_squared = 0, relative_1sd = 0, relative_2sd = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const double common = 1 + kScaleSd * Rng(5, 0, seed).Normal();
    Trajectories result = AlongRays(TestCamera(), Flock(6), [&](Id id, int frame) {
      return common * (1 + kOwnSd * Rng(6, id * 100 + frame, seed).Normal());
    });
    result.has_sd_depth = true;
    for (Trajectory& trajectory : result.trajectories) {
      for (TrajectoryPoint& point : trajectory.points) {
        point.sd_depth = std::hypot(kScaleSd, kOwnSd) *
                         (TestCamera().CamFromWorld(point.frame) * point.position).z;
      }
    }
    const TrajectoryScores s = Score(Flock(6), result, kScaleSd);
    if (*s.within_1sd > 0.5) ++within;
    z_squared += *s.scale_z * *s.scale_z / seeds;
    relative_1sd += *s.relative_within_1sd / seeds;
    relative_2sd += *s.relative_within_2sd / seeds;
  }
  EXPECT_NEAR(static_cast<double>(within) / seeds, 0.68, 0.07);  // the common error moves all
  EXPECT_NEAR(std::sqrt(z_squared), 1, 0.12);
  EXPECT_NEAR(relative_1sd, 0.68, 0.05);
  EXPECT_NEAR(relative_2sd, 0.95, 0.03);
}

TEST(TrajectoryScores, TooSmallDeviationsShow) {
  Trajectories result = AlongRays(TestCamera(), Flock(6), [](Id, int) { return 1.1; });
  result.has_sd_depth = true;
  for (Trajectory& trajectory : result.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) point.sd_depth = 0.1;
  }
  EXPECT_DOUBLE_EQ(*Score(Flock(6), result).within_2sd, 0);
}

TEST(MatchTrajectories, ByImageFragmentsBelongToTheAnimalTheyFollow) {
  // Animal 1 comes back as ids 70 and 80, animal 2 as 60, one id follows nobody.
  const Trajectories truth = Flock(2);
  Trajectories result;
  const auto& first = truth.trajectories[0].points;
  const auto& second = truth.trajectories[1].points;
  result.trajectories = {{60, second},
                         {70, {first.begin(), first.begin() + 12}},
                         {80, {first.begin() + 10, first.end()}},
                         {90, {At(3, {-6, 20, 9})}}};
  result = AlongRays(TestCamera(), result, [](Id, int) { return 1.5; });  // depth does not matter
  const MatchedTrajectories matched =
      MatchTrajectories({.by_image = true}, TestCamera(), truth, result);
  EXPECT_EQ(matched.points.size(), 40u);
  std::set<std::pair<Id, Id>> owners;
  for (const MatchedPoint& point : matched.points) {
    owners.emplace(point.truth_id, point.result_id);
    EXPECT_NEAR(point.result_depth / point.truth_depth, 1.5, 1e-12);
  }
  EXPECT_EQ(owners, (std::set<std::pair<Id, Id>>{{1, 70}, {1, 80}, {2, 60}}));
}

TEST(MatchTrajectories, ByImageASwappedIdFollowsTheMajority) {
  // Id 5 follows animal 1 for 15 frames, then animal 2 for 5: all its rows belong to animal 1.
  const Trajectories truth = Flock(2);
  Trajectory five{5, truth.trajectories[0].points};
  for (int k = 15; k < 20; ++k) five.points[k] = truth.trajectories[1].points[k];
  Trajectories result;
  result.trajectories = {five};
  const MatchedTrajectories matched =
      MatchTrajectories({.by_image = true}, TestCamera(), truth, result);
  EXPECT_EQ(matched.points.size(), 20u);
  for (const MatchedPoint& point : matched.points) EXPECT_EQ(point.truth_id, 1);
  EXPECT_NE(matched.points.back().result_depth, matched.points.back().truth_depth);
}

TEST(MatchTrajectories, WorldFromCameraUndoesTheCamera) {
  const Camera camera = TestCamera();
  Trajectories in_camera = Flock(2);
  for (Trajectory& trajectory : in_camera.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) {
      point.position = camera.CamFromWorld(point.frame) * point.position;
    }
  }
  const Trajectories back = WorldFromCamera(camera, in_camera);
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t m = 0; m < 20; ++m) {
      EXPECT_NEAR(Norm(back.trajectories[k].points[m].position -
                       Flock(2).trajectories[k].points[m].position),
                  0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace flocklift
