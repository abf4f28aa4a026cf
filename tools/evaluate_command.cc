// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/evaluate_command.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "tools/fit_command.h"
#include "tools/round_trip_chain.h"
#include "tools/round_trip_table.h"
#include "tools/stage.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

// One comparison to make.
struct Job {
  FileKind kind = FileKind::kTracks;
  fs::path truth, result;
  std::optional<fs::path> camera;
};

// The first of the files that is there.
std::optional<fs::path> FirstOf(const std::vector<fs::path>& candidates) {
  for (const fs::path& path : candidates) {
    if (!path.empty() && fs::is_regular_file(path)) return path;
  }
  return std::nullopt;
}

std::optional<fs::path> CameraFor(const EvaluateCommand& command, const fs::path& truth,
                                  const fs::path& result) {
  if (!command.camera.empty()) return command.camera;
  return FirstOf({truth.parent_path() / "camera.yaml", result.parent_path() / "camera.yaml"});
}

FileKind KindOf(const EvaluateCommand& command, const fs::path& path) {
  if (command.kind == "tracks") return FileKind::kTracks;
  if (command.kind == "trajectories") return FileKind::kTrajectories;
  return KindOfFile(path);
}

Job JobOfFiles(const EvaluateCommand& command) {
  const FileKind kind = KindOf(command, command.truth);
  if (KindOf(command, command.result) != kind) {
    const bool tracks = kind == FileKind::kTracks;
    throw InputError(
        command.result.string(), 0,
        tracks ? "holds trajectories, the truth tracks" : "holds tracks, the truth trajectories",
        "give two files of one kind, or say it with --kind");
  }
  Job job{kind, command.truth, command.result, {}};
  if (kind == FileKind::kTrajectories) {
    job.camera = CameraFor(command, command.truth, command.result);
  }
  return job;
}

std::vector<Job> JobsOfRoundTrip(const EvaluateCommand& command) {
  const fs::path truth = command.round_trip / "truth", result = command.round_trip / "result";
  std::vector<Job> jobs;
  if (command.kind != "trajectories" && fs::exists(truth / "tracks_true.csv") &&
      fs::exists(result / "tracks.csv")) {
    jobs.push_back({FileKind::kTracks, truth / "tracks_true.csv", result / "tracks.csv", {}});
  }
  if (command.kind != "tracks") {
    const auto true_paths = FirstOf({truth / "trajectories.csv", truth / "trajectories.h5"});
    const auto result_paths = FirstOf({result / "trajectories.csv", result / "trajectories.h5"});
    if (true_paths && result_paths) {
      jobs.push_back({FileKind::kTrajectories, *true_paths, *result_paths,
                      CameraFor(command, *true_paths, *result_paths)});
    }
  }
  if (jobs.empty()) {
    throw InputError(command.round_trip.string(), 0,
                     "has no truth/ and result/ with files to compare",
                     "give a folder as `flocklift demo` leaves it, or --truth and --result");
  }
  return jobs;
}

// What each stage adds to the error of the flock that comes out; nothing where a stage is missing.
std::optional<Json> ShareOut(const EvaluateCommand& command, const CommonOptions& common,
                             Stage* stage) {
  try {
    const RoundTripChain chain = RunRoundTripChain(command.round_trip, common);
    for (const std::string& line : chain.missing) stage->Warn(line);
    if (chain.legs.empty()) return std::nullopt;
    for (const fs::path& input : chain.inputs) stage->AddInput(input);
    stage->BeginPhase("round trip");
    const RoundTripScores scores = ScoreRoundTrip(
        command.shares_of, chain.replay, chain.camera, chain.truth, chain.legs, chain.fps,
        common.seed, common.ThreadCount(), MakeFilmAgain(chain, command.round_trip, common));
    if (scores.IsUsable()) return RoundTripAsJson(scores);
    stage->Warn("no animal is in the picture at both ends of a replay: give a shorter --lead");
  } catch (const CannotFit& reason) {
    stage->Warn(std::string("no shares of the stages: ") + reason.what());
  }
  return std::nullopt;
}

void PrintRoundTrip(const Json& figures) {
  fmt::print(
      "round trip: {:.3f} m and {:.1f} px after {:g} s (straight on: {:.3f} m, {:.1f} px), {} "
      "animals from {} starts\n{}",
      figures.at("error_m").get<double>(), figures.at("image_error_px").get<double>(),
      figures.at("lead_s").get<double>(), figures.at("straight_on_error_m").get<double>(),
      figures.at("straight_on_image_error_px").get<double>(), figures.at("animals").get<int>(),
      figures.at("starts").get<int>(), RoundTripTable(figures));
}

void PrintTable(const Json& scores) {
  for (const auto& [kind, figures] : scores.items()) {
    if (kind == "round_trip") {
      PrintRoundTrip(figures);
      continue;
    }
    fmt::print("{}\n", kind);
    for (const auto& [name, value] : figures.items()) {
      if (value.is_number_float()) {
        fmt::print("  {:26} {:>12.4f}\n", name, value.get<double>());
      } else {
        fmt::print("  {:26} {:>12}\n", name, value.dump());
      }
    }
  }
}

}  // namespace

void RunEvaluate(const EvaluateCommand& command, const CommonOptions& common_given) {
  const bool round_trip = !command.round_trip.empty();
  Check(round_trip ? command.truth.empty() && command.result.empty()
                   : !command.truth.empty() && !command.result.empty(),
        "give --truth and --result, or --round-trip alone");
  CommonOptions common = common_given;
  if (common.out.empty()) common.out = round_trip ? command.round_trip : ".";
  const std::vector<Job> jobs =
      round_trip ? JobsOfRoundTrip(command) : std::vector<Job>{JobOfFiles(command)};
  EvaluationOptions options = command.evaluation;
  options.match.by_image = command.match == "image" || (command.match == "auto" && round_trip);

  Stage stage("evaluate", common);
  stage.options() = {{"tracks", OptionsAsJson(options.tracks)},
                     {"match", options.match.by_image ? "image" : "id"},
                     {"match_gate_px", options.match.gate_px},
                     {"truth_frame", options.truth_in_camera_frame ? "camera" : "world"},
                     {"result_frame", options.result_in_camera_frame ? "camera" : "world"}};
  const bool with_shares = round_trip && command.shares && command.kind == "auto";
  if (with_shares) stage.options()["shares"] = OptionsAsJson(command.shares_of);
  if (options.scale_sd) stage.options()["scale_sd"] = *options.scale_sd;
  for (const Job& job : jobs) {
    stage.AddInput(job.truth);
    stage.AddInput(job.result);
    if (job.camera) stage.AddInput(*job.camera);
    if (job.kind == FileKind::kTrajectories && !options.scale_sd) {
      if (const auto scale_sd = ScaleSdOfSummary(job.result.parent_path())) {
        stage.options()["scale_sd"] = *scale_sd;
      }
    }
  }
  if (stage.IsUpToDate()) return;

  Json scores = Json::object();
  std::vector<std::string> warnings;
  for (const Job& job : jobs) {
    if (job.kind == FileKind::kTracks) {
      stage.BeginPhase("tracks");
      scores["tracks"] = EvaluateTracks(options, job.truth, job.result, &warnings);
    } else {
      stage.BeginPhase("trajectories");
      scores["trajectories"] =
          EvaluateTrajectories(options, job.camera, job.truth, job.result, &warnings);
    }
  }
  stage.EndPhase();
  for (const std::string& warning : warnings) stage.Warn(warning);
  if (with_shares) {
    if (auto shares = ShareOut(command, common, &stage)) scores["round_trip"] = std::move(*shares);
    stage.EndPhase();
  }
  WriteTextFile(common.out / "scores.json", scores.dump(2) + "\n");
  stage.AddOutput("scores.json");
  stage.figures() = scores;
  if (!common.json && !common.quiet) PrintTable(scores);
  stage.Finish();
}

void AddEvaluateCommand(CLI::App& app) {
  std::shared_ptr<EvaluateCommand> command;
  CLI::App* sub = AddSubcommand<EvaluateCommand>(
      app, "evaluate", "Score tracks or trajectories against the truth",
      "Examples:\n"
      "  flocklift evaluate --truth tracks_true.csv --result tracks.csv\n"
      "  flocklift evaluate --truth truth/trajectories.csv --result trajectories.csv \\\n"
      "      --camera camera.yaml --match image\n"
      "  flocklift evaluate --round-trip demo",
      {.seed = true}, &RunEvaluate, &command);
  sub->get_option("--out")->default_val("")->description(
      "folder for scores.json; default: the folder of the round trip, or the current one");
  auto* truth = sub->add_option("--truth", command->truth, "the truth: tracks or trajectories");
  auto* result = sub->add_option("--result", command->result, "what is to be scored");
  truth->needs(result);
  result->needs(truth);
  sub->add_option("--round-trip", command->round_trip,
                  "a folder with truth/ and result/, as `demo` leaves it; also shares the error of "
                  "the replayed flock out among the stages, by running the chain again from each "
                  "on with the truth before it")
      ->excludes(truth)
      ->excludes(result);
  sub->add_option("--kind", command->kind, "what the files hold; auto: by their content")
      ->check(CLI::IsMember({"auto", "tracks", "trajectories"}))
      ->capture_default_str();

  sub->add_flag("--shares,!--no-shares", command->shares,
                "share the error out among the stages of a round trip");
  AddFlags(*sub, command->shares_of, "Round trip");

  const std::string tracks = "Tracks";
  AddFlags(*sub, command->evaluation.tracks, tracks);

  const std::string trajectories = "Trajectories";
  sub->add_option("--camera", command->camera,
                  "camera file: depth is along its axis; default: camera.yaml beside the files")
      ->group(trajectories);
  sub->add_option("--match", command->match,
                  "which result stands for which animal: id, or image (the animal that it follows "
                  "in the picture); auto: id for files, image for a round trip")
      ->check(CLI::IsMember({"auto", "id", "image"}))
      ->capture_default_str()
      ->group(trajectories);
  AddFlags(*sub, command->evaluation.match, trajectories);
  const auto frame_option = [&](const char* name, bool* in_camera_frame, const char* whose) {
    sub->add_option_function<std::string>(
           name,
           [in_camera_frame](const std::string& frame) { *in_camera_frame = frame == "camera"; },
           std::string("coordinates of the ") + whose + ": world (the default) or camera")
        ->check(CLI::IsMember({"world", "camera"}))
        ->group(trajectories);
  };
  frame_option("--truth-frame", &command->evaluation.truth_in_camera_frame, "truth");
  frame_option("--result-frame", &command->evaluation.result_in_camera_frame, "result");
  sub->add_option("--scale-sd", command->evaluation.scale_sd,
                  "relative sd of the common scale; default: as summary.reconstruct.json beside "
                  "the result says")
      ->check(CLI::Range(0.0, 1e3))
      ->group(trajectories);
}

}  // namespace flocklift
