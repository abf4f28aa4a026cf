// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/round_trip_chain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/core/io.h"
#include "tools/evaluate_command.h"
#include "tools/fit_command.h"
#include "tools/reconstruct_command.h"
#include "tools/simulate_command.h"
#include "tools/track_command.h"

namespace flocklift {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string Slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// Few birds in a small picture for two seconds.
constexpr const char* kScene = R"([scene]
seed = 3
duration = 2
fps = 25
warmup = 1
[[species]]
count = 8
start = [[-5, -5, 9], [5, 5, 15]]
[camera]
size = [640, 360]
position = [0, -25, 5]
[render]
noise = 1
)";

class RoundTripChainTest : public testing::Test {
 protected:
  RoundTripChainTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "truth");
    WriteTextFile(folder_ / "truth/scene.toml", kScene);
  }
  ~RoundTripChainTest() override { fs::remove_all(folder_); }

  static CommonOptions Into(const fs::path& out) {
    CommonOptions common;
    common.out = out;
    common.threads = 1;
    common.quiet = true;
    return common;
  }
  void Simulate() const {
    SimulateCommand command;
    command.scene = folder_ / "truth/scene.toml";
    RunSimulate(command, Into(folder_ / "truth"));
  }
  void Fly() const {
    Simulate();
    RunTrack({.video = folder_ / "truth/video.mp4"}, Into(folder_ / "result"));
    ReconstructCommand reconstruct;
    reconstruct.tracks = folder_ / "result/tracks.csv";
    reconstruct.camera = folder_ / "truth/camera.yaml";
    reconstruct.wingspan = "0.7,0.035";
    reconstruct.speed = "10,1";
    RunReconstruct(reconstruct, Into(folder_ / "result"));
    FitCommand fit;
    fit.trajectories = folder_ / "result/trajectories.csv";
    fit.camera = reconstruct.camera;
    fit.goal = "none";
    fit.free = {"alpha_a", "cruise"};
    fit.fit.depth_draws = 0;
    RunFit(fit, Into(folder_ / "result"));
  }
  Json Evaluated() const {
    RunEvaluate({.round_trip = folder_, .shares_of = {.lead = 0.4, .starts = 2}}, Into({}));
    return Json::parse(Slurp(folder_ / "summary.evaluate.json"));
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "flocklift_round_trip_chain_test";
};

TEST_F(RoundTripChainTest, SharesOutWhatAChainOfCommandsLeft) {
  Fly();
  const Json summary = Evaluated();
  const Json& trip = summary.at("figures").at("round_trip");
  std::vector<std::string> stages;
  double share = 0, image_share = 0;
  for (const Json& stage : trip.at("stages")) {
    stages.push_back(stage.at("stage"));
    if (stage.contains("share")) share += stage.at("share").get<double>();
    image_share += stage.at("image_share").get<double>();
  }
  EXPECT_EQ(stages, (std::vector<std::string>{"film", "track", "reconstruct", "fit", "start",
                                              "replay", "film again"}));
  EXPECT_NEAR(share, 1, 1e-9);
  EXPECT_NEAR(image_share, 1, 1e-9);
  EXPECT_GT(trip.at("animals"), 0);
  EXPECT_GT(trip.at("stages")[0].at("error_m"), trip.at("stages")[5].at("error_m"));
  // The folder has no replay: said, with the command.
  EXPECT_THAT(summary.at("warnings").dump(), HasSubstr("flocklift replay"));

  // The legs are those of the folder's own options.
  const Json fit = Json::parse(Slurp(folder_ / "round_trip/fit/summary.fit.json"));
  EXPECT_EQ(fit.at("options").at("free"), Json({"alpha_a", "cruise"}));
  EXPECT_EQ(fit.at("options").at("goal"), "none");
  const Json depth = Json::parse(Slurp(folder_ / "round_trip/track/summary.reconstruct.json"));
  EXPECT_EQ(depth.at("options").at("wingspan"), "0.7,0.035");

  // Again: the same bytes, and what was made is kept.
  const std::string scores = Slurp(folder_ / "scores.json");
  const auto filmed = fs::last_write_time(folder_ / "round_trip/track/video.mp4");
  Evaluated();
  EXPECT_EQ(Slurp(folder_ / "scores.json"), scores);
  EXPECT_EQ(fs::last_write_time(folder_ / "round_trip/track/video.mp4"), filmed);
}

TEST_F(RoundTripChainTest, SaysWhatIsMissingAndHowToMakeIt) {
  Simulate();
  const RoundTripChain chain = RunRoundTripChain(folder_, Into({}));
  EXPECT_TRUE(chain.legs.empty());
  ASSERT_EQ(chain.missing.size(), 3U);
  EXPECT_THAT(chain.missing[0], HasSubstr("flocklift track " + (folder_ / "truth").string()));
  EXPECT_THAT(chain.missing[1], HasSubstr("flocklift reconstruct "));
  EXPECT_THAT(chain.missing[2], HasSubstr("flocklift fit "));
  EXPECT_FALSE(fs::exists(folder_ / "round_trip"));
}

TEST_F(RoundTripChainTest, AnotherSceneThanTheTruthsIsNotTaken) {
  Fly();
  WriteTextFile(folder_ / "truth/scene.toml", std::string(kScene) + "\n# changed\n");
  const RoundTripChain chain = RunRoundTripChain(folder_, Into({}));
  EXPECT_TRUE(chain.legs.empty());
  EXPECT_THAT(chain.missing.back(), HasSubstr("has changed"));
}

}  // namespace
}  // namespace flocklift
