// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/simulate_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "simulate/core/scene_io.h"
#include "simulate/flock/force_types.h"
#include "simulate/flock/model.h"
#include "simulate/flock/simulate_scene.h"
#include "simulate/media/image_codec.h"
#include "simulate/render/film.h"
#include "simulate/synthetic.h"
#include "tools/scene_camera.h"
#include "tools/scene_input.h"
#include "tools/scene_scenery.h"
#include "tools/scene_tetrahedra.h"
#include "tools/size_text.h"
#include "tools/stage.h"

namespace flocklift {
namespace {

void PrintInfo(const ModelInfo& info) {
  const std::string source = info.source.empty() ? "" : " [" + info.source + "]";
  fmt::print("{}: {}{}\n", info.name, info.help, source);
  for (const ParameterInfo& p : info.parameters) {
    const std::string value = p.choices.empty() ? fmt::format("{:g} {}", p.value, p.unit)
                                                : p.choices[static_cast<std::size_t>(p.value)];
    const std::string choices =
        p.choices.empty() ? "" : fmt::format(": {}", fmt::join(p.choices, ", "));
    fmt::print("  {:<12} {:<16} {}{}\n", p.name, value, p.help, choices);
  }
  fmt::print("\n");
}

void PrintModels() {
  fmt::print("MODELS (model = NAME of a [[species]], with [species.parameters])\n\n");
  for (const ModelInfo& model : Models()) PrintInfo(model);
  fmt::print("FORCE TERMS (type = NAME of a [[species.force]], added to the model's)\n\n");
  for (const ModelInfo& force : ForceTypes()) PrintInfo(force);
}

// What a reconstruction may be told about the flock: the means over its animals and frames.
void AddMeans(const SceneResult& result, nlohmann::ordered_json* figures) {
  double speed = 0, wingspan = 0, rows = 0;
  const auto agents = static_cast<std::size_t>(result.agents);
  for (std::size_t k = 0; k < agents; ++k) {
    wingspan += result.animals[k].wingspan / static_cast<double>(agents);
    for (const TrajectoryPoint& point : result.truth.trajectories[k].points) {
      speed += Norm(point.velocity);
      ++rows;
    }
  }
  if (rows == 0) return;
  (*figures)["mean_speed"] = speed / rows;
  (*figures)["mean_wingspan"] = wingspan;
}

}  // namespace

void RunSimulate(const SimulateCommand& command, const CommonOptions& common) {
  if (command.list) return PrintModels();
  Check(!command.scene.empty(), "give a scene file, or --list");
  Scene scene = ReadScene(command.scene);
  if (command.seed) scene.seed = *command.seed;
  if (common.fps) scene.fps = *common.fps;
  if (command.until) scene.duration = std::min(scene.duration, *command.until);
  Check(scene.FrameCount() > 0, "--until leaves no frame");
  std::optional<std::pair<int, int>> size;
  if (!command.size.empty()) size = ParseSize(command.size, "--size");
  const Camera camera = SceneCamera(scene, size);

  Stage stage("simulate", common);
  stage.options() = OptionsAsJson(command.video);
  stage.options()["seed"] = scene.seed;
  stage.options()["fps"] = scene.fps;
  stage.options()["video"] = !command.no_video;
  stage.options()["tracks"] = !command.no_tracks;
  stage.options()["still"] = command.still;
  stage.options()["duration"] = scene.duration;
  stage.options()["size"] = fmt::format("{}x{}", camera.width, camera.height);
  stage.AddInput(command.scene);
  if (scene.camera.file) stage.AddInput(*scene.camera.file);
  AddMeshInputs(scene, &stage);
  stage.AddOutput("trajectories.csv");
  if (!command.no_tracks) stage.AddOutput("tracks_true.csv");
  stage.AddOutput("camera.yaml");
  const bool morphs = HasTetrahedra(scene);
  const std::filesystem::path mesh =
      morphs ? common.out / "tetrahedra.glb" : std::filesystem::path{};
  if (morphs) stage.AddOutput("tetrahedra.glb");
  if (!command.no_video) stage.AddOutput("video.mp4");
  if (command.still) stage.AddOutput("still.png");
  if (stage.IsUpToDate()) return;

  const Progress step_progress = stage.BeginPhase("record");
  const SceneResult result = SimulateScene(scene,
                                           {.threads = common.ThreadCount(),
                                            .checkpoint = common.out / ".simulate-checkpoint",
                                            .tetrahedra = mesh},
                                           step_progress);
  stage.EndPhase();
  stage.SplitPhase("prepare", result.prepare_wall_s, result.prepare_cpu_s);
  stage.SplitPhase("step", result.step_wall_s, result.step_cpu_s);
  const Scenery obstacles = SceneObstacles(result.obstacles);
  Scenery scenery = SceneScenery(scene, result.obstacles);
  std::optional<DrawnAnimals> others;
  if (morphs) {
    AddTetrahedra(scene, mesh, &scenery);
    others = WithoutTetrahedra(scene, result);
  }
  const Trajectories& filmed = others ? others->trajectories : result.truth;
  const std::vector<Animal>& animals = others ? others->animals : result.animals;
  std::optional<Tracks> tracks;
  if (!command.no_tracks) {
    stage.BeginPhase("observe");
    const Scenery* const hides = scene.render.obstacles ? &obstacles : nullptr;
    tracks = SynthesizeTracks(filmed, animals, camera, scene.fps, common.ThreadCount(), hides);
    if (morphs) {
      AddTetrahedraTracks(scene, result, mesh, camera, common.ThreadCount(), hides, &*tracks);
    }
  }
  const FilmOptions film{.fps = scene.fps,
                         .frames = scene.FrameCount(),
                         .seed = scene.seed,
                         .threads = common.ThreadCount(),
                         .video = command.video,
                         .scenery = &scenery};
  if (!command.no_video) {
    const Progress film_progress = stage.BeginPhase("film");
    FilmTrajectories(common.out / "video.mp4", filmed, animals, camera, scene.render, film,
                     film_progress);
  }
  stage.BeginPhase("write", "files");
  WriteTrajectories(common.out / "trajectories.csv", result.truth);
  if (tracks) WriteTrueTracks(common.out / "tracks_true.csv", *tracks);
  WriteCamera(common.out / "camera.yaml", camera);
  if (command.still) {
    WritePng(common.out / "still.png",
             DrawFrame(filmed, animals, camera, scene.render, film, scene.FrameCount()));
  }
  stage.EndPhase();

  stage.figures() = {{"agents", result.agents},
                     {"steps", result.steps},
                     {"mean_neighbours", result.mean_neighbours},
                     {"mde_share", result.mde_share},
                     {"frames", scene.FrameCount()}};
  AddMeans(result, &stage.figures());
  stage.Finish();
}

void AddSimulateCommand(CLI::App& app) {
  std::shared_ptr<SimulateCommand> command;
  CLI::App* sub = AddSubcommand<SimulateCommand>(
      app, "simulate", "Make the true paths, tracks and video of a scene",
      "Examples:\n"
      "  flocklift simulate data_synthetic/demo.toml --out truth\n"
      "  flocklift simulate scene.toml --no-video --seed 7 --out truth\n"
      "  flocklift simulate scene.toml --no-video --still --until 3 --size 640x360 --out look\n"
      "  flocklift simulate --list",
      {.fps = true}, &RunSimulate, &command);
  auto* scene = sub->add_option("scene", command->scene,
                                "a scene file (TOML; data_synthetic/README.md describes it)");
  sub->add_option("--seed", command->seed, "of all random numbers, instead of the scene's");
  sub->add_flag("--no-video", command->no_video, "write no video.mp4");
  sub->add_flag("--no-tracks", command->no_tracks,
                "write no tracks_true.csv: to look at every animal in every frame takes longer "
                "than to make it fly");
  sub->add_flag("--still", command->still, "write still.png, the last frame of the film");
  sub->add_option("--until", command->until, "end the scene after so many seconds");
  sub->add_option("--size", command->size, "of the image in pixels, WIDTHxHEIGHT: the same view");
  sub->add_flag("--list", command->list,
                "name the models, force terms and their parameters with units and defaults")
      ->excludes(scene);
  AddFlags(*sub, command->video, "Video");
}

}  // namespace flocklift
