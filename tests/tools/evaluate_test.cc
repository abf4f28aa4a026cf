// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "simulate/camera/camera_io.h"
#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "tools/evaluate_command.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class EvaluateTest : public testing::Test {
 protected:
  EvaluateTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "truth");
    fs::create_directories(folder_ / "result");
    common_.quiet = true;
    common_.out.clear();
    camera_.width = 1000;
    camera_.height = 800;
    camera_.intrinsics = {.fx = 1000, .fy = 1000, .cx = 499.5, .cy = 399.5};
    camera_.cam_from_world = LookAt({0, -40, 2}, {0, 0, 2});
    for (Id id = 1; id <= 6; ++id) {
      Tracklet tracklet{id, {}};
      Trajectory trajectory{id, {}};
      for (int frame = 1; frame <= 10; ++frame) {
        tracklet.detections.push_back(
            {frame, Box::Around({20.0 * frame, 50.0 * static_cast<double>(id)}, 8, 6), 1, {}});
        TrajectoryPoint point;
        point.frame = frame;
        point.position = {0.3 * frame, 2.0 * static_cast<double>(id), static_cast<double>(id)};
        trajectory.points.push_back(point);
      }
      tracks_.tracklets.push_back(tracklet);
      paths_.trajectories.push_back(trajectory);
    }
    paths_.fps = 30;
  }
  ~EvaluateTest() override { fs::remove_all(folder_); }

  Json Scores() const {
    std::ifstream file(folder_ / "scores.json");
    return Json::parse(file);
  }

  // The same paths under other ids.
  Trajectories Renamed() const {
    Trajectories renamed = paths_;
    for (Trajectory& trajectory : renamed.trajectories) trajectory.id += 100;
    return renamed;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "flocklift_evaluate_test";
  CommonOptions common_;
  Camera camera_;
  Tracks tracks_;
  Trajectories paths_;
};

TEST_F(EvaluateTest, TellsFilesByTheirContent) {
  WriteTracks(folder_ / "a.csv", tracks_);
  WriteTrajectories(folder_ / "b.csv", paths_);
  WriteTracks(folder_ / "a.h5", tracks_);
  WriteTrajectories(folder_ / "b.h5", paths_);
  WriteTextFile(folder_ / "c.csv", "# a comment\n\n  frame,id,x,y,z\n1,1,0,0,0\n");
  EXPECT_EQ(KindOfFile(folder_ / "a.csv"), FileKind::kTracks);
  EXPECT_EQ(KindOfFile(folder_ / "b.csv"), FileKind::kTrajectories);
  EXPECT_EQ(KindOfFile(folder_ / "a.h5"), FileKind::kTracks);
  EXPECT_EQ(KindOfFile(folder_ / "b.h5"), FileKind::kTrajectories);
  EXPECT_EQ(KindOfFile(folder_ / "c.csv"), FileKind::kTrajectories);
  EXPECT_THROW(KindOfFile(folder_ / "none.csv"), InputError);
}

TEST_F(EvaluateTest, RoundTripScoresWhatIsThere) {
  WriteTracks(folder_ / "truth/tracks_true.csv", tracks_);
  tracks_.tracklets.pop_back();
  WriteTracks(folder_ / "result/tracks.csv", tracks_);
  RunEvaluate({.round_trip = folder_}, common_);
  EXPECT_NEAR(Scores().at("tracks").at("Recall").get<double>(), 5.0 / 6, 1e-12);
  EXPECT_FALSE(Scores().contains("trajectories"));

  WriteTrajectories(folder_ / "truth/trajectories.csv", paths_);
  WriteTrajectories(folder_ / "result/trajectories.csv", Renamed());  // matched by image
  WriteCamera(folder_ / "truth/camera.yaml", camera_);
  RunEvaluate({.round_trip = folder_}, common_);
  EXPECT_NEAR(Scores().at("trajectories").at("depth_err_median_pct").get<double>(), 0, 1e-6);
  EXPECT_EQ(Scores().at("trajectories").at("coverage"), 1);
  EXPECT_EQ(Scores().at("trajectories").at("depth_spearman"), 1);
}

TEST_F(EvaluateTest, UsesTheScaleThatTheSummaryStates) {
  paths_.has_sd_depth = true;
  for (Trajectory& trajectory : paths_.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) point.sd_depth = 1;
  }
  WriteTrajectories(folder_ / "truth/trajectories.csv", paths_);
  WriteTrajectories(folder_ / "result/trajectories.csv", paths_);
  WriteCamera(folder_ / "truth/camera.yaml", camera_);
  RunEvaluate({.round_trip = folder_}, common_);
  EXPECT_FALSE(Scores().at("trajectories").contains("scale_z"));
  WriteTextFile(folder_ / "result/summary.reconstruct.json", R"({"figures": {"scale_sd": 0.1}})");
  RunEvaluate({.round_trip = folder_}, common_);
  EXPECT_NEAR(Scores().at("trajectories").at("scale_z").get<double>(), 0, 1e-9);
}

TEST_F(EvaluateTest, FilesAreMatchedByIdUnlessAskedOtherwise) {
  WriteTrajectories(folder_ / "a.csv", paths_);
  WriteTrajectories(folder_ / "b.csv", Renamed());
  WriteCamera(folder_ / "c.yaml", camera_);
  common_.out = folder_;
  EvaluateCommand command{.truth = folder_ / "a.csv", .result = folder_ / "b.csv"};
  command.camera = folder_ / "c.yaml";
  RunEvaluate(command, common_);
  EXPECT_EQ(Scores().at("trajectories").at("rows"), 0);
  command.match = "image";
  RunEvaluate(command, common_);
  EXPECT_EQ(Scores().at("trajectories").at("rows"), 60);
}

TEST_F(EvaluateTest, SaysWhenIdsNameOtherAnimals) {
  WriteTrajectories(folder_ / "a.csv", paths_);
  std::swap(paths_.trajectories.front().points, paths_.trajectories.back().points);
  std::swap(paths_.trajectories[1].points, paths_.trajectories[3].points);
  WriteTrajectories(folder_ / "b.csv", paths_);
  WriteCamera(folder_ / "camera.yaml", camera_);
  std::vector<std::string> warnings;
  EvaluateTrajectories({}, folder_ / "camera.yaml", folder_ / "a.csv", folder_ / "b.csv",
                       &warnings);
  EXPECT_THAT(warnings, testing::ElementsAre(testing::HasSubstr("--match image")));
}

TEST_F(EvaluateTest, BadInputIsRefusedAndWritesNothing) {
  WriteTracks(folder_ / "a.csv", tracks_);
  WriteTrajectories(folder_ / "b.csv", paths_);
  common_.out = folder_ / "out";
  EXPECT_THROW(RunEvaluate({}, common_), std::invalid_argument);
  EXPECT_THROW(RunEvaluate({.round_trip = folder_}, common_), InputError);
  EXPECT_THROW(RunEvaluate({.truth = folder_ / "a.csv", .result = folder_ / "b.csv"}, common_),
               InputError);
  EXPECT_THROW(RunEvaluate({.truth = folder_ / "a.csv", .result = folder_ / "no.csv"}, common_),
               InputError);
  EvaluateCommand by_image{.truth = folder_ / "b.csv", .result = folder_ / "b.csv"};
  by_image.match = "image";
  EXPECT_THROW(RunEvaluate(by_image, common_), std::invalid_argument);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace flocklift
