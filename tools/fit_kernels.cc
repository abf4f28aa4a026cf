// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/fit_kernels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include "reconstruct/fit/kernel_fit.h"
#include "simulate/camera/camera_io.h"
#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "tools/fit_comparison.h"
#include "tools/kernel_picture.h"
#include "tools/stage.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void RefuseWhatKernelsLack(const FitCommand& command) {
  const auto refuse = [](bool given, const char* flag, const char* why) {
    Check(!given, std::string(flag) + " is not for --model kernels: " + why);
  };
  refuse(!command.set.empty(), "--set", "kernels have no parameters");
  refuse(!command.start.empty(), "--start", "kernels start from nothing");
  refuse(!command.walls.empty(), "--walls", "only what animals do to each other is fitted");
  refuse(command.goal != "auto" && command.goal != "none", "--goal",
         "only what animals do to each other is fitted");
  refuse(command.method != "auto", "--method", "there is one way to fit them");
  for (const std::string& name : command.compare) {
    Check(name == kKernelsModel || command.kernels.order == 2,
          "--compare " + name + " predicts accelerations, kernels of order 1 velocities");
    Check(name == kKernelsModel || command.also.empty(),
          "--compare " + name + " takes one file: leave --also out");
  }
}

// The file's fps where it says one.
Trajectories ReadOne(const fs::path& path, const CommonOptions& common, std::optional<double>* fps,
                     fs::path* said_by) {
  Trajectories flock = ReadTrajectories(path);
  if (common.fps || !flock.fps) return flock;
  if (!*fps) {
    *fps = flock.fps;
    *said_by = path;
  } else if (std::abs(**fps - *flock.fps) > 1e-9 * **fps) {
    throw InputError(path.string(), 0,
                     fmt::format("is of {:g} frames per second, {} of {:g}", *flock.fps,
                                 said_by->string(), **fps),
                     "films that are fitted together need one rate");
  }
  return flock;
}

double KnownShare(const FittedKernel& kernel) {
  double known = 0, all = 0;
  for (std::size_t k = 0; k < kernel.points.size(); ++k) {
    const double low = kernel.points[k == 0 ? 0 : k - 1].distance;
    const double high = kernel.points[std::min(k + 1, kernel.points.size() - 1)].distance;
    const double pairs = 0.5 * (high - low) * kernel.points[k].density;
    all += pairs;
    if (kernel.points[k].known) known += pairs;
  }
  return all > 0 ? known / all : 0;
}

Json AsJson(const KernelFit& fit, int order) {
  Json json = {{"method", kKernelsModel},
               {"order", order},
               {"files", fit.flocks},
               {"animals", fit.animals},
               {"dimensions", fit.dimensions},
               {"rows", fit.rows},
               {"position_noise", fit.position_noise},
               {"diffusion", fit.diffusion},
               {"explained", fit.explained},
               {"effective_parameters", fit.effective},
               {"intervals", fit.intervals},
               {"converged", fit.converged}};
  if (!fit.left_out.name.empty()) {
    json["left_out"] = {{"name", fit.left_out.name}, {"found_share_of_pairs", fit.left_out.share}};
  }
  for (const FittedKernel& kernel : fit.kernels) {
    json["kernels"].push_back({{"name", kernel.name},
                               {"unit", kernel.Unit(order)},
                               {"nearest", kernel.basis.low()},
                               {"farthest", kernel.basis.high()},
                               {"known_share_of_pairs", KnownShare(kernel)}});
  }
  return json;
}

// A dozen lines for the terminal; the file has all.
void PrintKernels(const KernelFit& fit, int order) {
  constexpr int kLines = 8;
  for (const FittedKernel& kernel : fit.kernels) {
    fmt::print(stderr, "  {:<12} {:>12} {:>12}\n", "distance", kernel.name, "sd");
    fmt::print(stderr, "  {:<12} {:>12} {:>12}\n", "m", kernel.Unit(order), "");
    const std::size_t n = kernel.points.size();
    for (std::size_t line = 0; line < kLines; ++line) {
      const KernelPoint& point = kernel.points[std::min(n - 1, (2 * line + 1) * n / (2 * kLines))];
      fmt::print(stderr, "  {:<12.4g} {:>12} {:>12.2g}\n", point.distance,
                 point.known ? fmt::format("{:.4g}", point.value) : "unknown", point.sd);
    }
  }
}

}  // namespace

void RunKernelFit(const FitCommand& command, const CommonOptions& common) {
  Stage stage("fit", common);
  KernelFitOptions options = command.kernels;
  options.kernels = command.free;
  options.bridged_gap = command.fit.bridged_gap;
  RefuseWhatKernelsLack(command);
  CheckComparable(command.compare);
  stage.options() = {{"model", command.model},
                     {"free", command.free},
                     {"compare", command.compare},
                     {"kernels", OptionsAsJson(options)},
                     {"fit", OptionsAsJson(command.fit)},
                     {"seed", common.seed}};
  if (common.fps) stage.options()["fps"] = *common.fps;
  std::vector<fs::path> paths = {command.trajectories};
  paths.insert(paths.end(), command.also.begin(), command.also.end());
  std::map<std::string, fs::path> by_bytes;
  for (const fs::path& path : paths) {
    RequireFile(path, "give files that `flocklift reconstruct` or `simulate` wrote");
    stage.AddInput(path);
    const auto [other, is_new] = by_bytes.emplace(Sha256OfFile(path), path);
    if (!is_new) {
      throw InputError(path.string(), 0, "is the same as " + other->second.string(),
                       "give each film once: twice the same counts as twice the evidence");
    }
  }
  FitProblem problem;
  problem.model.name = kKernelsModel;
  if (!command.camera.empty()) {
    stage.AddInput(command.camera);
    problem.camera = ReadCamera(command.camera);
  }
  stage.AddOutput("kernels.csv");
  stage.AddOutput("kernels.svg");
  if (stage.IsUpToDate()) return;

  std::optional<double> fps = common.fps;
  fs::path said_by;
  std::vector<Trajectories> flocks;
  for (const fs::path& path : paths) flocks.push_back(ReadOne(path, common, &fps, &said_by));
  if (!fps && problem.camera) fps = problem.camera->fps;
  if (!fps) {
    throw InputError(command.trajectories.string(), 0, "says no frames per second", "give --fps");
  }

  const Progress progress = stage.BeginPhase("regress", "rounds");
  const KernelFit fit =
      FitKernels(options, flocks, *fps, common.seed, common.ThreadCount(), progress);
  stage.EndPhase();
  if (!fit.IsUsable()) {
    throw CannotFit(command.trajectories.string() + ": " + StatusText(fit.status));
  }
  stage.figures() = AsJson(fit, options.order);
  std::vector<ModelScore> scores;
  if (command.fit.held_out > 0 || !command.compare.empty()) {
    std::vector<std::string> models = command.compare;
    if (std::find(models.begin(), models.end(), kKernelsModel) == models.end()) {
      models.emplace_back(kKernelsModel);
    }
    stage.BeginPhase("predict");
    scores = CompareModels(command.fit, problem, options, models, flocks, *fps, common.seed,
                           common.ThreadCount());
    stage.EndPhase();
  }
  for (const ModelScore& score : scores) {
    if (score.model == kKernelsModel && score.r2_held_out) {
      stage.figures()["r2_held_out"] = *score.r2_held_out;
    }
  }
  if (command.compare.empty()) scores.clear();
  if (!scores.empty()) stage.figures()["comparison"] = ScoresAsJson(scores);
  WriteTextFile(common.out / "kernels.csv", KernelsTable(fit.kernels, options.order));
  WriteTextFile(common.out / "kernels.svg", KernelsPicture(fit.kernels, options.order));
  for (const std::string& warning : fit.warnings) stage.Warn(warning);
  stage.Finish();
  if (common.quiet || common.json) return;
  PrintKernels(fit, options.order);
  if (!scores.empty()) PrintScores(scores);
}

}  // namespace flocklift
