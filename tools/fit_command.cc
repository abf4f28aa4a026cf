// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/fit_command.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "reconstruct/fit/engine_flight.h"
#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "simulate/core/model_terms.h"
#include "simulate/core/parameters.h"
#include "simulate/core/scene_io.h"
#include "simulate/core/text.h"
#include "simulate/flock/force_types.h"
#include "tools/evaluate_files.h"
#include "tools/fit_comparison.h"
#include "tools/fit_figures.h"
#include "tools/fit_kernels.h"
#include "tools/fit_list.h"
#include "tools/kept_memory.h"
#include "tools/scene_input.h"
#include "tools/stage.h"
#include "tools/walls.h"

namespace flocklift {
namespace {

constexpr int kLargestArray = 32 << 20, kMostKept = 256 << 20;  // that a fit keeps [bytes]

// What NAME=VALUE says.
double ValueIn(const std::string& text) {
  const auto equals = text.find('=');
  if (equals != std::string::npos) {
    if (const auto value = ParseReal(std::string_view(text).substr(equals + 1))) return *value;
  }
  Check(false, "--set " + text + " is not NAME=VALUE");
  return 0;
}

// The scene's numbers, then the start's, then those that are set.
ModelSpec ModelOf(const FitCommand& command, const std::optional<Scene>& scene) {
  ModelSpec model;
  model.where = "--model";
  if (scene) {
    const SpeciesSpec& species = internal::SpeciesOf(*scene, command.model);
    model = species.model;
    for (const ModelSpec& force : species.forces) model.terms.push_back(CompleteForce(force));
  }
  if (!command.start.empty()) {
    const ModelSpec start = ReadParameters(command.start).model;
    if (start.name != command.model) {
      throw InputError(start.where, 0, "the start is of model " + start.name,
                       "give --model " + start.name);
    }
    model.where = start.where;
    for (const auto& [name, value] : start.parameters) model.parameters[name] = value;
    for (const auto& [name, word] : start.choices) model.choices[name] = word;
    for (const auto& [name, where] : start.where_of) model.where_of[name] = where;
    if (!scene) {
      for (const ModelSpec& term : start.terms) model.terms.push_back(CompleteForce(term));
    }
    for (const std::string& name : NumberNames(start)) {
      if (name.find('.') == std::string::npos) continue;
      SetNumber(name, *FindNumber(start, name), start.where, &model);
    }
  }
  model.name = command.model;
  for (const std::string& text : command.set) {
    const auto equals = text.find('=');
    const double value = ValueIn(text);
    const std::string name = text.substr(0, equals);
    if (name.find('.') != std::string::npos) {
      SetNumber(name, value, "--set " + text, &model);
      continue;
    }
    model.parameters[name] = value;
    model.where_of[name] = "--set " + text;
  }
  return model;
}

void ParseGoal(const std::string& text, FitProblem* problem) {
  if (text == "auto" || text == "none" || text == "seek") {
    problem->goal = text == "auto"   ? GoalChoice::kWhenHeld
                    : text == "none" ? GoalChoice::kNone
                                     : GoalChoice::kSought;
    return;
  }
  const std::optional<std::vector<double>> place = ParseNumbers(text, 3);
  const std::optional<std::vector<double>> ball = ParseNumbers(text, 4);
  Check(place || (ball && (*ball)[3] >= 0),
        "--goal " + text + " is none of auto, none, seek, X,Y,Z and X,Y,Z,REACH");
  const std::vector<double>& numbers = place ? *place : *ball;
  problem->goal = GoalChoice::kGiven;
  problem->goal_position = {numbers[0], numbers[1], numbers[2]};
  if (ball) problem->goal_reach = numbers[3];
}

}  // namespace

void RunFit(const FitCommand& command, const CommonOptions& common) {
  KeepFreedMemory(kLargestArray, kMostKept);
  if (command.model == kKernelsModel) {
    RunKernelFit(command, common);
    return;
  }
  Check(command.also.empty(), "--also is for --model kernels: others are fitted to one file");
  KernelFitOptions kernels = command.kernels;  // to be compared with
  kernels.bridged_gap = command.fit.bridged_gap;
  for (const std::string& name : command.compare) {
    Check(name != kKernelsModel || kernels.order == 2,
          "--compare kernels needs --order 2: the other models make accelerations");
  }
  CheckComparable(command.compare, command.scene.empty() ? "" : command.model);
  Stage stage("fit", common);
  stage.options() = {{"model", command.model},  {"free", command.free}, {"set", command.set},
                     {"walls", command.walls},  {"goal", command.goal}, {"method", command.method},
                     {"search", command.search}};
  FitOptions options = command.fit;
  if (options.scale_sd == 0) {  // the reconstruction may have said
    options.scale_sd = ScaleSdOfSummary(command.trajectories.parent_path()).value_or(0);
  }
  stage.options()["fit"] = OptionsAsJson(options);
  stage.options()["seed"] = common.seed;
  if (common.fps) stage.options()["fps"] = *common.fps;
  RequireFile(command.trajectories, "give the file that `flocklift reconstruct` wrote");
  stage.AddInput(command.trajectories);
  FitProblem problem;
  problem.free = command.free;
  problem.walls = ParseWalls(command.walls);
  problem.method = FitMethodOf(command.method);
  problem.search = SimulatedSearchOf(command.search);
  ParseGoal(command.goal, &problem);
  if (!command.start.empty()) stage.AddInput(command.start);
  if (!command.scene.empty()) {
    problem.scene = ReadSceneAsInput(command.scene, &stage);
  }
  problem.model = ModelOf(command, problem.scene);
  if (command.list) {
    fmt::print("{}", ListNumbers(problem.model));
    return;
  }
  if (!command.camera.empty()) {
    stage.AddInput(command.camera);
    problem.camera = ReadCamera(command.camera);
  }
  stage.AddOutput("parameters.toml");
  if (stage.IsUpToDate()) return;

  const Trajectories trajectories = ReadTrajectories(command.trajectories);
  std::optional<double> fps = common.fps ? common.fps : trajectories.fps;
  if (!fps && problem.camera) fps = problem.camera->fps;
  if (!fps) {
    throw InputError(command.trajectories.string(), 0, "says no frames per second", "give --fps");
  }
  const Progress progress = stage.BeginPhase("regress", "refits");
  const FitResult result =
      FitModel(options, problem, trajectories, *fps, common.seed, common.ThreadCount(), progress);
  stage.EndPhase();
  if (!result.IsUsable()) {
    throw CannotFit(command.trajectories.string() + ": " + StatusText(result.status));
  }
  const std::vector<ModelScore> scores =
      CompareModels(options, problem, kernels, command.compare, {trajectories}, *fps, common.seed,
                    common.ThreadCount());
  WriteParameters(common.out / "parameters.toml", result.parameters);
  for (const std::string& warning : result.warnings) stage.Warn(warning);
  stage.figures() = FitFigures(result);
  if (!scores.empty()) stage.figures()["comparison"] = ScoresAsJson(scores);
  stage.Finish();
  if (common.quiet || common.json) return;
  PrintFit(result);
  if (!scores.empty()) PrintScores(scores);
}

void AddFitCommand(CLI::App& app) {
  std::shared_ptr<FitCommand> command;
  CLI::App* sub = AddSubcommand<FitCommand>(
      app, "fit", "Find the interaction parameters behind trajectories",
      "Examples:\n"
      "  flocklift fit trajectories.csv --model boids --out run\n"
      "  flocklift fit trajectories.csv --model boids --free alpha_a,alpha_c --set d_v=15\n"
      "  flocklift fit trajectories.csv --free alpha_s,alpha_a,d_s,d_v "
      "--set taper=1,cruise=0,noise_time=0\n"
      "  flocklift fit trajectories.csv --compare boids,linear\n"
      "  flocklift fit truth/trajectories.csv --walls=-20,-20,2,20,20,22\n"
      "  flocklift fit trajectories.csv --model swarm --set evolution=3 --goal 0,0,5,4\n"
      "  flocklift fit first.csv --also second.csv --model kernels --out kernels\n"
      "  flocklift fit trajectories.csv --model bswarm --start parameters.toml "
      "--walls=0,0,0,1,1,1\n"
      "  flocklift fit trajectories.csv --model shape --scene moon.toml --free alpha,w_dis,s_max\n"
      "  flocklift fit trajectories.csv --model forces --scene scene.toml --free "
      "alignment.gain,drag.rate\n"
      "  flocklift fit trajectories.csv --model forces --scene scene.toml --list",
      {.fps = true, .seed = true}, &RunFit, &command);
  sub->add_option("trajectories", command->trajectories, "trajectories (CSV, or HDF5)")->required();
  sub->add_option("--model", command->model,
                  "the model; `flocklift simulate --list` names them; or kernels: attraction and "
                  "alignment as curves over distance, without a form, with 95 % bands (writes "
                  "kernels.csv and kernels.svg, no parameters.toml)")
      ->capture_default_str();
  sub->add_option("--also", command->also,
                  "of kernels: another film of the same kind of flock, counted with the first; "
                  "once for each")
      ->allow_extra_args(false);
  sub->add_option(
         "--free", command->free,
         "what to fit, separated by commas: weights and, of smooth models (tapers above 0, no "
         "cruise, noise_time 0), radii too; of a scene's [[species.force]] by type and parameter, "
         "alignment.gain, with a number from the second of a type on, alignment2.gain; of kernels "
         "attraction, alignment; default: all weights, or kernels")
      ->delimiter(',');
  sub->add_option("--set", command->set, "NAME=VALUE of parameters that are not free")
      ->delimiter(',');
  sub->add_option("--start", command->start, "parameters.toml that gives what is not free");
  sub->add_option("--scene", command->scene,
                  "scene file that says what the animals fly to and around (shapes, paths, goals, "
                  "obstacles, walls), what forces it adds to --model and what all numbers start "
                  "from; shape, morph, crowd and forces need it");
  sub->add_flag("--list", command->list,
                "print what --free and --set may name, with its values, and stop");
  sub->add_option("--camera", command->camera, "camera file: where depth errors point");
  AddWallsFlag(*sub, &command->walls);
  sub->add_option("--goal", command->goal,
                  "a point that attracts all: auto (sought when something holds the animals in "
                  "place), none, seek, X,Y,Z, or of a swarm X,Y,Z,REACH, within which it does "
                  "not pull [m]")
      ->capture_default_str();
  sub->add_option(
         "--method", command->method,
         "state-space (all at once, by likelihood; smooth models), errors-in-variables "
         "(regression with instruments), differences (least squares on plain differences: "
         "badly biased, for comparison), noise-field (scale and gain of a swarm's curl noise, "
         "its seed unknown), statistics (simulations that move as the data do; models "
         "without usable derivatives: bswarm, lin, opensteer, and with --scene shape, morph, "
         "crowd), or auto, which never takes "
         "differences")
      ->check(CLI::IsMember({"auto", "state-space", "errors-in-variables", "differences",
                             "noise-field", "statistics"}))
      ->capture_default_str();
  sub->add_option("--search", command->search,
                  "of simulated statistics: crs or isres, then bobyqa, or bobyqa alone")
      ->check(CLI::IsMember({"bobyqa", "crs", "isres"}))
      ->capture_default_str();
  sub->add_option(
         "--compare", command->compare,
         "models, separated by commas, to be fitted to all but the last part of the time "
         "too (--held-out) and compared there, with constant velocity, as a table; kernels "
         "among them; models that are fitted by statistics are flown on by the engine, which takes "
         "as long as their fit does, and --model in its --scene")
      ->delimiter(',');
  AddFlags(*sub, command->fit, "Fit");
  AddFlags(*sub, command->kernels, "Model kernels");
}

}  // namespace flocklift
