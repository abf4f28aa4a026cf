// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/depth_table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "simulate/camera/camera_io.h"
#include "simulate/core/io.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

// A second of a small flock, by the name of one of the cases.
constexpr const char* kScene = R"(
[scene]
seed = 1
duration = 1
fps = 20
[[species]]
name = "left"
count = 4
start = [[-8, -8, 8], [-2, 8, 16]]
[[species]]
name = "right"
count = 2
start = [[2, -8, 8], [8, 8, 16]]
)";

class DepthTableTest : public testing::Test {
 protected:
  DepthTableTest()
      : folder_(fs::path(testing::TempDir()) /
                ("flocklift_depth_table_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "depth_crossing.toml") << kScene;
  }
  ~DepthTableTest() override { fs::remove_all(folder_); }

  const fs::path folder_;
  const DepthCase case_{.scene = "crossing",
                        .faults = {.gaps = 30, .gap_length = 3, .switches = 20}};
};

TEST_F(DepthTableTest, TheTwinsTruthHasExactlyTheRowsOfItsTracks) {
  const DepthTwin twin = MakeDepthTwin(case_, folder_, 9, 2, 1);
  std::set<std::pair<Id, int>> rows, truth;
  for (const Tracklet& t : twin.tracks.tracklets) {
    for (const Detection& d : t.detections) rows.emplace(t.id, d.frame);
  }
  double speed = 0, count = 0;
  for (const Trajectory& t : twin.truth.trajectories) {
    for (const TrajectoryPoint& p : t.points) {
      truth.emplace(t.id, p.frame);
      speed += Norm(p.velocity);
      ++count;
    }
  }
  EXPECT_EQ(rows, truth);
  EXPECT_GT(rows.size(), 60u);
  EXPECT_LT(rows.size(), 180u);  // some are lost
  EXPECT_NEAR(twin.knowledge.speed->mean, speed / count, 1e-9);
}

TEST_F(DepthTableTest, SeedsDifferAndRepeat) {
  const DepthTwin a = MakeDepthTwin(case_, folder_, 9, 1, 1);
  const DepthTwin same = MakeDepthTwin(case_, folder_, 9, 1, 2);
  const DepthTwin other = MakeDepthTwin(case_, folder_, 9, 2, 1);
  const auto first = [](const DepthTwin& twin) {
    return twin.tracks.tracklets.front().detections.front().box.left;
  };
  EXPECT_EQ(first(a), first(same));
  EXPECT_NE(first(a), first(other));
}

TEST_F(DepthTableTest, WhatIsToldDiffersFromTheTruthAsTheCaseSays) {
  DepthCase wrong = case_;
  wrong.told_speed = 0.8;
  wrong.told_focal = 1.1;
  const DepthTwin right = MakeDepthTwin(case_, folder_, 9, 1, 1);
  const DepthTwin twin = MakeDepthTwin(wrong, folder_, 9, 1, 1);
  EXPECT_NEAR(twin.knowledge.speed->mean, 0.8 * right.knowledge.speed->mean, 1e-9);
  EXPECT_NEAR(twin.camera.intrinsics.fx, 1.1 * right.camera.intrinsics.fx, 1e-9);
  EXPECT_EQ(twin.tracks.tracklets.size(), right.tracks.tracklets.size());
}

TEST_F(DepthTableTest, EveryMethodCoversEveryRow) {
  const DepthTwin twin = MakeDepthTwin(case_, folder_, 9, 1, 1);
  for (const DepthMethod& method : DepthMethods()) {
    const DepthRun run = RunDepthMethod(method, twin, 1);
    EXPECT_EQ(run.scores.coverage, 1) << method.name;
    EXPECT_GT(run.scores.error_median, 0) << method.name;
  }
}

TEST_F(DepthTableTest, FilesReadBack) {
  const DepthTwin twin = MakeDepthTwin(case_, folder_, 9, 1, 1);
  WriteDepthTwin(folder_ / "twin", twin);
  Tracks tracks = ReadTracks(folder_ / "twin/tracks.csv");
  ReadShapes(folder_ / "twin/shapes.csv", &tracks);
  EXPECT_EQ(tracks.tracklets.size(), twin.tracks.tracklets.size());
  EXPECT_EQ(ReadTrajectories(folder_ / "twin/truth.csv").trajectories.size(),
            twin.truth.trajectories.size());
  EXPECT_NEAR(ReadCamera(folder_ / "twin/camera.yaml").intrinsics.fx, twin.camera.intrinsics.fx,
              1e-9);
}

TEST_F(DepthTableTest, TheTableAveragesOverSeedsBelowTheConstantDepth) {
  TrajectoryScores a, b;
  a.constant_error_median = b.constant_error_median = 0.2;
  a.constant_error_p90 = b.constant_error_p90 = 0.4;
  a.error_median = 0.02;
  b.error_median = 0.04;
  a.error_p90 = b.error_p90 = 0.08;
  a.coverage = b.coverage = 1;
  a.skill = 0.1;
  b.skill = 0.2;
  const std::string table = DepthTable({{"circling", 20, "batch", {a, b}, {1, 3}}});
  EXPECT_NE(table.find("| circling | 20 | constant depth | 20.0 / 40.0 |"), std::string::npos)
      << table;
  EXPECT_NE(table.find("| circling | 20 | batch | 3.0 / 8.0 | 0.0 / 0.0 | 0.15 |"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("| 2.00 |"), std::string::npos) << table;
}

// Birds that wheel about a point by the forces of boids.
constexpr const char* kCircling = R"(
[scene]
seed = 1
duration = 8
fps = 25
warmup = 10
box = [[-100, -100, 0], [100, 100, 100]]
[[species]]
name = "jackdaw"
wingspan = 0.7
wingspan_spread = 0.05
speed = 10
speed_spread = 0.05
start = [[-12, -12, 8], [12, 12, 16]]
model = "boids"
[species.parameters]
d_s = 4
d_v = 12
taper = 3
alpha_s = 1.5
alpha_c = 0.1
alpha_a = 0.7
level = 0.8
noise = 1
goal_range = 20
[[goal]]
position = [0, 0, 12]
weight = 0.6
[camera]
fov = 50
position = [0, -45, 1.7]
look_at = [0, 0, 12]
)";

double MeanLogDepth(const Camera& camera, const Trajectories& flock) {
  double sum = 0, count = 0;
  for (const Trajectory& t : flock.trajectories) {
    for (const TrajectoryPoint& p : t.points) {
      sum += std::log((camera.CamFromWorld(p.frame) * p.position).z);
      ++count;
    }
  }
  return sum / count;
}

// Forces that are there are found and make relative depth better, by a lot; of the common scale
// they know nothing, and it moves only as far as speeds and sizes are others on better paths.
TEST_F(DepthTableTest, ForcesTellDepthWhereAFlockHasThem) {
  std::ofstream(folder_ / "depth_circling.toml") << kCircling;
  const DepthMethod batch{"batch"}, dynamics{"dynamics", ReconstructMethod::kDynamics};
  double batch_error = 0, error = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const DepthTwin twin = MakeDepthTwin({.scene = "circling"}, folder_, 12, seed, 1);
    const DepthRun without = RunDepthMethod(batch, twin, 1);
    const DepthRun with = RunDepthMethod(dynamics, twin, 1);
    batch_error += without.scores.scaled_error_median;
    error += with.scores.scaled_error_median;
    ASSERT_TRUE(with.report.dynamics.has_value());
    EXPECT_NEAR(MeanLogDepth(twin.camera, with.result), MeanLogDepth(twin.camera, without.result),
                0.015);
    if (with.report.dynamics->kept == 0) continue;
    EXPECT_LT(with.report.dynamics->dynamics_error, with.report.dynamics->batch_error);
    EXPECT_GT(with.report.dynamics->weight, 0);
    EXPECT_LE(with.report.dynamics->weight, 1);
  }
  EXPECT_LT(error, 0.75 * batch_error);
}

// Without sizes the batch solution hardly knows who is in front: drawing the flock together finds
// that too.
TEST_F(DepthTableTest, ForcesTellDepthWithoutSizesToo) {
  std::ofstream(folder_ / "depth_circling.toml") << kCircling;
  const DepthMethod batch{.name = "batch", .use_size = false};
  const DepthMethod dynamics{
      .name = "dynamics", .method = ReconstructMethod::kDynamics, .use_size = false};
  double batch_error = 0, error = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const DepthTwin twin = MakeDepthTwin({.scene = "circling"}, folder_, 12, seed, 1);
    batch_error += RunDepthMethod(batch, twin, 1).scores.scaled_error_median;
    error += RunDepthMethod(dynamics, twin, 1).scores.scaled_error_median;
  }
  EXPECT_LT(error, 0.7 * batch_error);
}

}  // namespace
}  // namespace flocklift
