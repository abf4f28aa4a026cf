// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/simulate_command.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "simulate/camera/camera_io.h"
#include "simulate/camera/projection.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

std::string Slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

class SimulateCommandTest : public testing::Test {
 protected:
  SimulateCommandTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~SimulateCommandTest() override { fs::remove_all(folder_); }

  // A short film of few birds in a small picture.
  fs::path Scene(const std::string& parameters = "") {
    std::ofstream(folder_ / "scene.toml")
        << "[scene]\nseed = 3\nduration = 0.4\nfps = 25\nwarmup = 1\n[[species]]\ncount = 6\n"
        << "[species.parameters]\n"
        << parameters << "\n"
        << "[camera]\nsize = [320, 180]\n";
    return folder_ / "scene.toml";
  }

  // `flocklift simulate SCENE ARGUMENTS --quiet --out FOLDER/out`.
  fs::path Run(const fs::path& scene, const std::string& arguments, const std::string& out) {
    CLI::App app;
    AddSimulateCommand(app);
    app.parse("simulate " + scene.string() + " " + arguments + " --quiet --out " +
              (folder_ / out).string());
    return folder_ / out;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "flocklift_simulate_command_test";
};

TEST_F(SimulateCommandTest, WritesTheFilesOfTheContract) {
  const fs::path out = Run(Scene(), "", "out");
  EXPECT_GT(fs::file_size(out / "video.mp4"), 1000U);
  const Trajectories truth = ReadTrajectories(out / "trajectories.csv");
  EXPECT_EQ(truth.fps, 25);
  EXPECT_TRUE(truth.has_velocity);
  EXPECT_TRUE(truth.has_orientation);
  ASSERT_EQ(truth.trajectories.size(), 6U);
  EXPECT_EQ(truth.trajectories[0].points.size(), 10U);

  // A track is where the camera sees the bird.
  const Camera camera = ReadCamera(out / "camera.yaml");
  EXPECT_EQ(camera.fps, 25);
  const Tracks tracks = ReadTracks(out / "tracks_true.csv");
  ASSERT_FALSE(tracks.tracklets.empty());
  for (const Tracklet& tracklet : tracks.tracklets) {
    const Trajectory& path = truth.trajectories[static_cast<std::size_t>(tracklet.id - 1)];
    for (const Detection& detection : tracklet.detections) {
      const Vec3d position = path.points[static_cast<std::size_t>(detection.frame - 1)].position;
      const Vec2d pixel = Project(camera.intrinsics, *camera.cam_from_world * position);
      EXPECT_NEAR(detection.box.Center().x, pixel.x, 1e-3);
      EXPECT_NEAR(detection.box.Center().y, pixel.y, 1e-3);
    }
  }

  const auto summary = nlohmann::json::parse(Slurp(out / "summary.simulate.json"));
  const auto& figures = summary["figures"];
  EXPECT_EQ(figures["agents"], 6);
  EXPECT_EQ(figures["steps"], (25 + 9) * 4);
  EXPECT_EQ(figures["mde_share"], 0);
  EXPECT_GT(figures["mean_neighbours"], 0);
  EXPECT_NEAR(figures["mean_wingspan"], 0.7, 1e-9);
  EXPECT_NEAR(figures["mean_speed"], 10, 4);
  EXPECT_EQ(summary["phases"][0]["name"], "prepare");
  EXPECT_EQ(summary["phases"][1]["name"], "step");
  EXPECT_GT(summary["phases"][1]["wall_s"], 0);
}

TEST_F(SimulateCommandTest, WithoutTracksThePathsAreTheSame) {
  const fs::path scene = Scene();
  const fs::path with = Run(scene, "--no-video", "with");
  const fs::path without = Run(scene, "--no-video --no-tracks", "without");
  EXPECT_TRUE(fs::exists(with / "tracks_true.csv"));
  EXPECT_FALSE(fs::exists(without / "tracks_true.csv"));
  EXPECT_EQ(Slurp(with / "trajectories.csv"), Slurp(without / "trajectories.csv"));
}

TEST_F(SimulateCommandTest, SameBytesAtAnyThreadCount) {
  const fs::path scene = Scene();
  const fs::path one = Run(scene, "--threads 1", "one"), two = Run(scene, "--threads 2", "two");
  for (const char* file : {"trajectories.csv", "tracks_true.csv", "camera.yaml", "video.mp4"}) {
    EXPECT_EQ(Slurp(one / file), Slurp(two / file)) << file;
    EXPECT_FALSE(Slurp(one / file).empty()) << file;
  }
}

TEST_F(SimulateCommandTest, SeedAndVideoAreOptions) {
  const fs::path scene = Scene();
  const fs::path a = Run(scene, "--no-video", "a");
  const fs::path same = Run(scene, "--no-video --seed 3", "same");
  const fs::path other = Run(scene, "--no-video --seed 4", "other");
  EXPECT_FALSE(fs::exists(a / "video.mp4"));
  EXPECT_EQ(Slurp(a / "trajectories.csv"), Slurp(same / "trajectories.csv"));
  EXPECT_NE(Slurp(a / "trajectories.csv"), Slurp(other / "trajectories.csv"));
}

TEST_F(SimulateCommandTest, WrongParameterNamesItsLineAndLeavesNothing) {
  try {
    Run(Scene("alpha_sep = 1"), "", "out");
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("scene.toml:9: "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("`alpha_s`"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(SimulateCommandTest, WhatAModelLacksIsToldWithItsLineAndItsMend) {
  struct Case {
    std::string species, fault, mend;
  };
  const std::vector<Case> cases{
      {"model = \"shape\"", "the model shape of the species a has no shape", "shape = \"NAME\""},
      {"model = \"morph\"", "the model morph of the species a has no start", "start = \"NAME\""},
      {"model = \"crowd\"", "the model crowd has no goal for the species a", "[[goal]]"},
  };
  for (const Case& c : cases) {
    std::ofstream(folder_ / "scene.toml")
        << "[scene]\nduration = 0.4\nfps = 25\n[[species]]\nname = \"a\"\ncount = 6\n"
        << c.species << "\n";
    try {
      Run(folder_ / "scene.toml", "--no-video", "out");
      ADD_FAILURE() << "nothing was thrown: " << c.species;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("scene.toml:7: " + c.fault + "; "), std::string::npos) << text;
      EXPECT_NE(text.find(c.mend), std::string::npos) << text;
    }
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
}

TEST_F(SimulateCommandTest, SwarmInThePlaneIsRefusedWithItsLine) {
  std::ofstream(folder_ / "scene.toml")
      << "[scene]\nduration = 0.4\nfps = 25\ndimensions = 2\n[[species]]\ncount = 6\n"
      << "model = \"swarm\"\n";
  try {
    Run(folder_ / "scene.toml", "--no-video", "out");
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("scene.toml:7: the model swarm needs three dimensions; "),
              std::string::npos)
        << text;
  }
}

TEST_F(SimulateCommandTest, ListNamesModelsAndParameters) {
  CLI::App app;
  AddSimulateCommand(app);
  testing::internal::CaptureStdout();
  app.parse("simulate --list");
  const std::string text = testing::internal::GetCapturedStdout();
  for (const char* word : {"boids:", "boids2d:", "lin:", "alpha_s", "m/s^2", "w_sep"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word;
  }
}

}  // namespace
}  // namespace flocklift
