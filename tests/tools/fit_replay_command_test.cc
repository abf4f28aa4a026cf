// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "simulate/core/parameters.h"
#include "simulate/core/rng.h"
#include "simulate/core/scene_io.h"
#include "tests/reconstruct/fit/flocks.h"
#include "tools/fit_command.h"
#include "tools/replay_command.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

std::string Slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

class FitReplayCommandTest : public testing::Test {
 protected:
  FitReplayCommandTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    Scene scene = BoidsScene(3);
    scene.duration = 4;
    WriteTrajectories(folder_ / "trajectories.csv", Fly(scene));
  }
  ~FitReplayCommandTest() override { fs::remove_all(folder_); }

  fs::path Run(const std::string& arguments, const std::string& out) {
    CLI::App app;
    AddFitCommand(app);
    AddReplayCommand(app);
    app.parse(arguments + " --quiet --out " + (folder_ / out).string());
    return folder_ / out;
  }
  std::string Fit(const std::string& arguments) const {
    return "fit " + (folder_ / "trajectories.csv").string() + " --walls=-20,-20,2,20,20,22 " +
           arguments;
  }
  std::string Replay(const std::string& arguments) const {
    return "replay " + (folder_ / "trajectories.csv").string() + " --parameters " +
           (folder_ / "fit" / "parameters.toml").string() + " " + arguments;
  }
  static nlohmann::json Figures(const fs::path& summary) {
    return nlohmann::json::parse(Slurp(summary)).at("figures");
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "flocklift_fit_replay_command_test";
};

TEST_F(FitReplayCommandTest, FitWritesParametersAndWhatIsKnownOfThem) {
  const fs::path out = Run(Fit("--set d_s=2 --threads 1"), "fit");
  const Parameters parameters = ReadParameters(out / "parameters.toml");
  EXPECT_EQ(parameters.model.name, "boids");
  EXPECT_EQ(parameters.model.parameters.at("d_s"), 2);
  EXPECT_EQ(parameters.posterior.free.size(), 6U);
  ASSERT_TRUE(parameters.walls.has_value());
  EXPECT_EQ(parameters.walls->high.z, 22);
  EXPECT_NEAR(parameters.model.parameters.at("alpha_s"), 2, 0.2);
  const nlohmann::json figures = Figures(out / "summary.fit.json");
  EXPECT_EQ(figures.at("weights").size(), 6U);
  EXPECT_TRUE(figures.contains("r2_held_out"));
  EXPECT_TRUE(figures.at("worst_direction").at("weights").contains("cruise"));

  const fs::path again = Run(Fit("--set d_s=2 --threads 3"), "again");
  EXPECT_EQ(Slurp(out / "parameters.toml"), Slurp(again / "parameters.toml"));
}

TEST_F(FitReplayCommandTest, FitComparesModelsOnHeldOutTime) {
  const fs::path out = Run(Fit("--set d_s=2 --compare linear,boids"), "fit");
  const nlohmann::json scores = Figures(out / "summary.fit.json").at("comparison");
  ASSERT_EQ(scores.size(), 3U);
  std::map<std::string, double> of;
  for (std::size_t k = 0; k < 3; ++k) {
    of[scores[k].at("model")] = scores[k].at("r2_held_out");
    if (k > 0) {
      EXPECT_LE(scores[k].at("r2_held_out"), scores[k - 1].at("r2_held_out"));
    }
  }
  EXPECT_EQ(of.at("constant velocity"), 0);
  EXPECT_EQ(scores[0].at("model"), "boids");  // which flew them
  EXPECT_GT(of.at("boids"), 0);
  EXPECT_ANY_THROW(Run(Fit("--compare shape"), "none"));  // its meshes are not in the file
  EXPECT_FALSE(fs::exists(folder_ / "none" / "parameters.toml"));
}

TEST_F(FitReplayCommandTest, FitNamesItsMethodAndSaysNoNumberForWhatIsNotKnown) {
  const nlohmann::json figures =
      Figures(Run(Fit("--set d_s=1e-6 --method differences"), "fit") / "summary.fit.json");
  EXPECT_EQ(figures.at("method"), "differences");
  for (const nlohmann::json& weight : figures.at("weights")) {
    EXPECT_EQ(weight.at("value").is_null(), !weight.at("determined").get<bool>());
    EXPECT_TRUE(weight.at("name") != "alpha_s" || weight.at("value").is_null());
  }
  EXPECT_ANY_THROW(Run(Fit("--method guess"), "none"));
}

TEST_F(FitReplayCommandTest, FitStartsFromAFileAndFreesWhatIsAsked) {
  Run(Fit("--set d_s=2"), "fit");
  const std::string start = "--start " + (folder_ / "fit" / "parameters.toml").string();
  const Parameters parameters =
      ReadParameters(Run(Fit(start + " --free alpha_a,level"), "part") / "parameters.toml");
  EXPECT_EQ(parameters.posterior.free, (std::vector<std::string>{"alpha_a", "level"}));
  EXPECT_EQ(parameters.model.parameters.at("d_s"), 2);
  EXPECT_THROW(Run(Fit(start + " --model boids2d"), "none"), InputError);
}

// The scene says what surrounds the animals and what the numbers start from, --set changes those.
TEST_F(FitReplayCommandTest, FitsWithinAScene) {
  Scene scene;
  scene.fps = 10;
  scene.substeps = 1;
  scene.duration = 4;
  scene.box = {{-10, -5, 0}, {10, 5, 0.5}};
  SpeciesSpec walkers;
  walkers.count = 12;
  walkers.start = Region{{-7, -4, 0}, {0, 4, 0.5}};
  walkers.model.name = "crowd";
  walkers.model.parameters = {{"f_max", 1.2}, {"gamma", 2}};
  scene.species = {walkers};
  scene.goals.resize(1);
  scene.goals[0].position = {8, 0, 0};
  WriteTrajectories(folder_ / "walkers.csv", Fly(scene));
  WriteScene(folder_ / "scene.toml", scene);
  const fs::path out = Run("fit " + (folder_ / "walkers.csv").string() + " --model crowd --scene " +
                               (folder_ / "scene.toml").string() +
                               " --free f_max --set f_max=1 --search bobyqa --local-evaluations 15"
                               " --window 1 --compare crowd,linear",
                           "crowd");
  const Parameters parameters = ReadParameters(out / "parameters.toml");
  EXPECT_EQ(parameters.model.parameters.at("gamma"), 2);
  EXPECT_NEAR(parameters.model.parameters.at("f_max"), 1.2, 0.1);
  const nlohmann::json figures = Figures(out / "summary.fit.json");
  EXPECT_EQ(figures.at("method"), "statistics");
  EXPECT_TRUE(figures.at("misfit").contains("target_distance"));
  std::map<std::string, double> of;
  for (const auto& score : figures.at("comparison")) {
    if (!score.at("r2_held_out").is_null()) of[score.at("model")] = score.at("r2_held_out");
  }
  EXPECT_LT(of.at("crowd"), 1);
  const std::string replay = "replay " + (folder_ / "walkers.csv").string() + " --parameters " +
                             (out / "parameters.toml").string();
  EXPECT_THROW(Run(replay, "none"), InputError);  // where do they go?
  EXPECT_FALSE(fs::exists(folder_ / "none" / "trajectories.csv"));
  const auto end =
      Figures(Run(replay + " --frame 1 --scene " + (folder_ / "scene.toml").string(), "replay") /
              "summary.replay.json")
          .at("divergence")
          .back();
  EXPECT_LT(end.at("model_rms"), 0.5 * end.at("straight_on_rms").get<double>());
}

// The forces of a scene have names, which parameters.toml keeps and a replay flies by.
TEST_F(FitReplayCommandTest, FitsTheForcesOfAScene) {
  Scene scene = BoidsScene(5);
  scene.duration = 4;
  SpeciesSpec& birds = scene.species[0];
  birds.model = {.name = "forces", .parameters = {}, .where = {}, .where_of = {}};
  const auto force = [](const char* type, std::map<std::string, double> parameters) {
    return ModelSpec{
        .name = type, .parameters = std::move(parameters), .where = {}, .where_of = {}};
  };
  birds.forces = {force("alignment", {{"gain", 1}, {"radius", 5}}),
                  force("alignment", {{"gain", 0.4}, {"radius", 15}}), force("walls", {}),
                  force("drag", {{"rate", 0.1}}), force("noise", {})};
  WriteTrajectories(folder_ / "birds.csv", Fly(scene));
  WriteScene(folder_ / "scene.toml", scene);
  const std::string fit = "fit " + (folder_ / "birds.csv").string() + " --model forces --scene " +
                          (folder_ / "scene.toml").string() + " ";
  const fs::path out = Run(fit + "--set alignment2.gain=0.1", "fit");
  const Parameters parameters = ReadParameters(out / "parameters.toml");
  EXPECT_EQ(
      parameters.posterior.free,
      (std::vector<std::string>{"alignment.gain", "alignment2.gain", "walls.gain", "drag.rate"}));
  ASSERT_EQ(parameters.model.terms.size(), 5U);
  EXPECT_EQ(parameters.model.terms[1].parameters.at("radius"), 15);
  EXPECT_NEAR(parameters.model.terms[0].parameters.at("gain"), 1, 0.4);
  const nlohmann::json figures = Figures(out / "summary.fit.json");
  EXPECT_EQ(figures.at("weights")[1].at("name"), "alignment2.gain");
  EXPECT_EQ(figures.at("weights")[1].at("value"), parameters.model.terms[1].parameters.at("gain"));

  const fs::path replay =
      Run("replay " + (folder_ / "birds.csv").string() + " --parameters " +
              (out / "parameters.toml").string() + " --frame 10 --duration 1 --noiseless",
          "replay");
  const auto end = Figures(replay / "summary.replay.json").at("divergence").back();
  EXPECT_LT(end.at("model_rms"), 0.8 * end.at("straight_on_rms").get<double>());

  const fs::path listed = Run(fit + "--list", "listed");
  EXPECT_FALSE(fs::exists(listed));
  for (const char* wrong : {"--free alignment3.gain", "--set drag.rat=1", "--free s_man"}) {
    try {
      Run(fit + wrong, "none");
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("did you mean"), std::string::npos) << error.what();
    }
    EXPECT_FALSE(fs::exists(folder_ / "none" / "parameters.toml"));
  }
}

TEST_F(FitReplayCommandTest, FitRefusesWithNothingWritten) {
  const auto refused = [&](const std::string& arguments) {
    EXPECT_ANY_THROW(Run(Fit(arguments), "none")) << arguments;
    EXPECT_FALSE(fs::exists(folder_ / "none" / "parameters.toml")) << arguments;
    EXPECT_FALSE(fs::exists(folder_ / "none" / "summary.fit.json")) << arguments;
  };
  refused("--model starlings");
  refused("--free alpha_x");
  refused("--set d_s");
  refused("--set d_s=far");
  refused("--set d_x=3");
  refused("--walls 1,2,3");
  refused("--walls=5,0,0,-5,1,1");
  refused("--goal 1,2");
  refused("--held-out 3");
  refused("--start /nowhere.toml");
  refused("--model shape");  // its mesh is in no file of trajectories
  refused("--model shape --scene /nowhere.toml");
  std::ofstream(folder_ / "trajectories.csv") << "# fps=30\nframe,id,x,y,z\n1,1,0,0,0\n2,1,0,0,1\n";
  EXPECT_THROW(Run(Fit(""), "none"), CannotFit);
  EXPECT_THROW(Run(Fit("--compare starlings"), "none"), InputError);  // before what is too short
  for (const char* model : {"boids", "linear", "swarm", "bswarm"}) {
    try {
      Run(Fit(std::string("--free alpha_x --model ") + model), "none");
      ADD_FAILURE() << model;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("--free: ")) << error.what();
    }
  }
  std::ofstream(folder_ / "trajectories.csv") << "frame,id,x,y,z\n1,1,0,0,0\n2,1,0,0,1\n";
  EXPECT_THROW(Run(Fit(""), "none"), InputError);  // no frames per second
}

TEST_F(FitReplayCommandTest, ReplayTellsHowItParts) {
  Run(Fit("--set d_s=2"), "fit");
  const fs::path out = Run(Replay("--frame 10 --duration 2"), "replay");
  const Trajectories replayed = ReadTrajectories(out / "trajectories.csv");
  EXPECT_EQ(replayed.trajectories.size(), 20U);
  EXPECT_EQ(SpanOf(replayed).first, 10);
  EXPECT_EQ(SpanOf(replayed).last, 70);
  EXPECT_FALSE(fs::exists(out / "video.mp4"));
  const nlohmann::json figures = Figures(out / "summary.replay.json");
  std::vector<double> times;
  for (const auto& entry : figures.at("divergence")) times.push_back(entry.at("time"));
  EXPECT_EQ(times.size(), 5U);  // 0.1, 0.2, 0.5, 1, 2
  EXPECT_NEAR(times.back(), 2, 1e-9);
  const auto& end = figures.at("divergence").back();
  EXPECT_LT(end.at("noiseless_rms"), end.at("straight_on_rms"));
  const auto& statistics = figures.at("statistics");
  EXPECT_EQ(statistics.front().at("time"), 0);
  EXPECT_NEAR(statistics.front().at("replay").at("polarisation").get<double>(),
              statistics.front().at("reconstruction").at("polarisation").get<double>(), 1e-3);
  // A pull keeps it nearer.
  const auto guided =
      Figures(Run(Replay("--frame 10 --duration 2 --alpha 0.3"), "guided") / "summary.replay.json");
  EXPECT_LT(guided.at("divergence").back().at("model_rms"),
            0.5 * end.at("model_rms").get<double>());
}

TEST_F(FitReplayCommandTest, ReplayFilmsUnlessToldNotTo) {
  Run(Fit("--set d_s=2"), "fit");
  Camera camera = PinholeCamera(60, 160, 90);
  camera.cam_from_world = LookAt({0, -60, 2}, {0, 0, 12});
  WriteCamera(folder_ / "camera.yaml", camera);
  const std::string film = "--duration 0.2 --camera " + (folder_ / "camera.yaml").string();
  EXPECT_TRUE(fs::exists(Run(Replay(film), "film") / "video.mp4"));
  EXPECT_FALSE(fs::exists(Run(Replay(film + " --no-video"), "dark") / "video.mp4"));
}

TEST_F(FitReplayCommandTest, ReplayRefusesWithNothingWritten) {
  Run(Fit("--set d_s=2"), "fit");
  const auto refused = [&](const std::string& arguments) {
    EXPECT_ANY_THROW(Run(Replay(arguments), "none")) << arguments;
    EXPECT_FALSE(fs::exists(folder_ / "none" / "trajectories.csv")) << arguments;
  };
  refused("--frame 100000");
  refused("--alpha 2");
  refused("--count -1");
  refused("--walls 1");
  std::ofstream(folder_ / "fit" / "parameters.toml") << "[model]\nname = \"boids\"\n[modl]\n";
  refused("");
}

}  // namespace
}  // namespace flocklift
