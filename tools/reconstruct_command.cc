// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/reconstruct_command.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "reconstruct/presets.h"
#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "tools/stage.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

// Relative sds of a mean that is given without one.
constexpr double kSpeedSd = 0.15, kWingspanSd = 0.06;

std::optional<Uncertain> ParseUncertain(const std::string& text, const std::string& flag,
                                        double relative_sd) {
  if (text.empty()) return std::nullopt;
  const MeanSd given = ParseMeanSd(text, flag);
  return Uncertain{given.mean, given.sd.value_or(relative_sd * given.mean)};
}

// Depths of the first frame of the tracks, from positions in the world frame.
FirstDepths ReadFirstDepths(const fs::path& path, const Camera& camera, int frame) {
  FirstDepths depths;
  for (const Trajectory& trajectory : ReadTrajectories(path).trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) {
      if (point.frame != frame) continue;
      depths[trajectory.id] = (camera.CamFromWorld(frame) * point.position).z;
    }
  }
  return depths;
}

// Every anchor must be of a row of the tracks: one that names nothing would silently do nothing.
void CheckAnchors(const fs::path& path, const std::vector<Anchor>& anchors, const Tracks& tracks) {
  std::set<std::pair<Id, int>> rows;
  for (const Tracklet& tracklet : tracks.tracklets) {
    for (const Detection& d : tracklet.detections) rows.emplace(tracklet.id, d.frame);
  }
  for (const Anchor& anchor : anchors) {
    if (rows.contains({anchor.id, anchor.frame})) continue;
    throw InputError(path.string(), 0,
                     "frame " + std::to_string(anchor.frame) + " of id " +
                         std::to_string(anchor.id) + " is not in the tracks",
                     "name an animal and a frame of the tracks, or take the anchor out");
  }
}

double FpsFor(const fs::path& path, const CommonOptions& common, const Tracks& tracks,
              const Camera& camera) {
  if (common.fps) return *common.fps;
  if (tracks.fps) return *tracks.fps;
  if (camera.fps) return *camera.fps;
  throw InputError(path.string(), 0, "says no frames per second, nor does the camera",
                   "give --fps, or `fps:` in the camera file");
}

SecondCamera ReadSecondCamera(const ReconstructCommand& command, const CommonOptions& common,
                              const Camera& first) {
  SecondCamera second;
  second.tracks = ReadTracks(command.second_tracks);
  second.camera = ReadCamera(command.second_camera);
  for (const auto& [camera, path] :
       {std::pair{&first, &command.camera},
        std::pair{&std::as_const(second.camera), &command.second_camera}}) {
    if (camera->KnowsGravity()) continue;
    throw InputError(path->string(), 0, "has no pose, which two cameras need",
                     "add `cam_from_world`, of both in one world");
  }
  second.fps = FpsFor(command.second_tracks, common, second.tracks, second.camera);
  second.offset = command.second_offset;
  return second;
}

nlohmann::ordered_json AsJson(const ReconstructReport& report) {
  nlohmann::ordered_json json = {
      {"method", NameOf(report.method)},       {"scale_sd", report.scale_sd},
      {"scale_from", report.scale_from},       {"outlook", report.outlook},
      {"observability", report.observability}, {"relative_sd", report.relative_sd},
      {"segments", report.segments},           {"cuts", report.cuts},
      {"pixel_sd", report.pixel_sd},           {"initial_cost", report.initial_cost},
      {"final_cost", report.final_cost},       {"iterations", report.iterations},
      {"converged", report.converged},         {"erratic", report.erratic}};
  for (const auto& [name, value] : report.spreads) json["spreads"][name] = value;
  if (report.speed_by_sizes) {
    json["speed_by_sizes"] = {{"log_over_stated", report.speed_by_sizes->mean},
                              {"sd", report.speed_by_sizes->sd}};
  }
  if (report.dynamics) {
    const DynamicsReport& d = *report.dynamics;
    json["dynamics"] = {{"kept", d.kept},
                        {"weight", d.weight},
                        {"of_windows", d.windows},
                        {"hidden_sightings", d.hidden},
                        {"prediction_error_batch", d.batch_error},
                        {"prediction_error_dynamics", d.dynamics_error}};
    for (const auto& [name, value] : d.forces) json["dynamics"]["forces"][name] = value;
  }
  if (report.second_camera) {
    const SecondCameraReport& s = *report.second_camera;
    json["second_camera"] = {{"tracks", s.tracks},       {"matched", s.matched},
                             {"ambiguous", s.ambiguous}, {"views", s.views},
                             {"offset_s", s.offset},     {"epipolar_error_px", s.error}};
  }
  for (const TermStatistics& term : report.terms) {
    json["residuals"].push_back({{"name", term.name},
                                 {"count", term.count},
                                 {"rms", term.rms},
                                 {"outliers", term.outliers}});
  }
  return json;
}

// Up to so many rows forces are tried without being asked for: at one to three milliseconds of CPU
// time a row that is a minute.
constexpr std::size_t kDynamicsRows = 30000;

ReconstructMethod MethodFor(const std::string& name, const Tracks& tracks) {
  if (name != "auto") return MethodOf(name);
  std::size_t rows = 0;
  for (const Tracklet& tracklet : tracks.tracklets) rows += tracklet.detections.size();
  return rows <= kDynamicsRows ? ReconstructMethod::kDynamics : ReconstructMethod::kBatch;
}

}  // namespace

Knowledge KnowledgeOf(const ReconstructCommand& command) {
  Knowledge knowledge;
  if (!command.preset.empty()) {
    const SpeciesPreset& preset = PresetOf(command.preset);
    knowledge.speed = preset.speed;
    knowledge.wingspan = preset.wingspan;
  }
  if (const auto speed = ParseUncertain(command.speed, "--speed", kSpeedSd)) {
    knowledge.speed = speed;
  }
  if (const auto wingspan = ParseUncertain(command.wingspan, "--wingspan", kWingspanSd)) {
    knowledge.wingspan = wingspan;
  }
  knowledge.near = command.near;
  knowledge.far = command.far;
  knowledge.use_size = !command.no_size;
  if (!command.anchors.empty()) knowledge.anchors = ReadAnchors(command.anchors);
  knowledge.second_camera = !command.second_tracks.empty();
  CheckKnowledge(knowledge);
  return knowledge;
}

void RunReconstruct(const ReconstructCommand& command, const CommonOptions& common) {
  ReconstructOptions options;
  options.knowledge = KnowledgeOf(command);
  options.pitch_deg = command.pitch_deg;
  options.batch = command.batch;
  options.dynamics = command.dynamics;
  options.cobyla = command.cobyla;
  options.checkpoint = common.out / ".reconstruct-windows";

  Stage stage("reconstruct", common);
  stage.options() = {{"method", command.method},   {"preset", command.preset},
                     {"speed", command.speed},     {"wingspan", command.wingspan},
                     {"no-size", command.no_size}, {"output", command.output}};
  if (command.near) stage.options()["near"] = *command.near;
  if (command.far) stage.options()["far"] = *command.far;
  if (command.second_offset) stage.options()["second-offset"] = *command.second_offset;
  if (command.pitch_deg) stage.options()["pitch"] = *command.pitch_deg;
  if (common.fps) stage.options()["fps"] = *common.fps;
  stage.options()["batch"] = OptionsAsJson(command.batch);
  stage.options()["dynamics"] = OptionsAsJson(command.dynamics);
  stage.options()["cobyla"] = OptionsAsJson(command.cobyla);
  RequireFile(command.tracks, "give the file that `flocklift track` wrote");
  RequireFile(command.camera, "make one with `flocklift camera` or `flocklift calibrate`");
  stage.AddInput(command.tracks);
  stage.AddInput(command.camera);
  fs::path shapes = command.shapes;
  if (shapes.empty()) {
    shapes = command.tracks.parent_path() / "shapes.csv";
    if (command.no_size || !fs::is_regular_file(shapes)) shapes.clear();
  }
  if (!shapes.empty()) stage.AddInput(shapes);
  if (!command.anchors.empty()) stage.AddInput(command.anchors);
  if (!command.first_depths.empty()) stage.AddInput(command.first_depths);
  if (!command.second_tracks.empty()) {
    stage.AddInput(command.second_tracks);
    stage.AddInput(command.second_camera);
  }
  stage.AddOutput(command.output);
  if (stage.IsUpToDate()) return;

  Progress progress = stage.BeginPhase("read", "files");
  Tracks tracks = ReadTracks(command.tracks);
  const Camera camera = ReadCamera(command.camera);
  if (!shapes.empty()) ReadShapes(shapes, &tracks);
  CheckAnchors(command.anchors, options.knowledge.anchors, tracks);
  if (!command.first_depths.empty()) {
    options.cobyla_first_depths =
        ReadFirstDepths(command.first_depths, camera, SpanOf(tracks).first);
  }
  options.method = MethodFor(command.method, tracks);
  const double fps = FpsFor(command.tracks, common, tracks, camera);
  if (!command.second_tracks.empty()) {
    options.second_camera = ReadSecondCamera(command, common, camera);
  }
  if (!common.quiet) fmt::print(stderr, "{}\n", LookAhead(options, tracks, camera, fps));
  progress = stage.BeginPhase("solve", command.method == "cobyla" || command.method == "lin-ceres"
                                           ? "frames"
                                           : "iterations");
  ReconstructResult result =
      Reconstruct(options, tracks, camera, fps, common.ThreadCount(), progress);
  if (command.method == "auto" && options.method == ReconstructMethod::kBatch &&
      !result.report.erratic) {
    result.report.observability += fmt::format(
        "; forces untried with more than {} rows (--method dynamics tries them)", kDynamicsRows);
  }
  stage.BeginPhase("write", "files");
  WriteTrajectories(common.out / command.output, result.trajectories);
  stage.EndPhase();
  for (const std::string& warning : result.report.warnings) stage.Warn(warning);
  stage.figures() = AsJson(result.report);
  stage.Finish();
}

void AddKnowledgeFlags(CLI::App& sub, ReconstructCommand* command) {
  const std::string group = "What you know (at least one that fixes the scale)";
  sub.add_option("--speed", command->speed,
                 "MEAN[,SD]: mean speed over the flock, and how sure that is [m/s]")
      ->group(group);
  sub.add_option("--wingspan", command->wingspan,
                 "MEAN[,SD]: wingspan tip to tip, sd between animals [m]")
      ->group(group);
  std::string names;
  for (const SpeciesPreset& preset : SpeciesPresets()) {
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  }
  sub.add_option("--preset", command->preset, "speed and wingspan of a species: " + names)
      ->group(group);
  sub.add_option("--near", command->near, "no animal is nearer [m]")
      ->check(CLI::PositiveNumber)
      ->group(group);
  sub.add_option("--far", command->far, "no animal is farther [m]")
      ->check(CLI::PositiveNumber)
      ->group(group);
  sub.add_option("--anchors", command->anchors,
                 "file of known positions: frame,id,x,y,z,sd with a header")
      ->group(group);
  CLI::Option* tracks = sub.add_option("--second-tracks", command->second_tracks,
                                       "tracks of the same animals by a second camera (their ids "
                                       "mean nothing; batch and dynamics)")
                            ->group(group);
  CLI::Option* camera =
      sub.add_option("--second-camera", command->second_camera, "its camera file, pose included")
          ->group(group)
          ->needs(tracks);
  tracks->needs(camera);
  sub.add_option(
         "--second-offset", command->second_offset,
         "to add to its times, (frame - 1) / fps, to have the first camera's [s]; not given: "
         "found within 2 s from how well the rays meet")
      ->check(CLI::Range(-1e6, 1e6))
      ->group(group)
      ->needs(tracks);
  sub.add_flag("--no-size", command->no_size, "ignore boxes and shapes")->group(group);
  sub.add_option("--pitch", command->pitch_deg,
                 "the optical axis points so many degrees above the horizon, without roll (for a "
                 "camera file without a pose)")
      ->check(CLI::Range(-90.0, 90.0))
      ->group(group);
}

void AddReconstructCommand(CLI::App& app) {
  std::shared_ptr<ReconstructCommand> command;
  CLI::App* sub = AddSubcommand<ReconstructCommand>(
      app, "reconstruct", "Find the depth of every tracked animal",
      "Examples:\n"
      "  flocklift reconstruct tracks.csv --camera camera.yaml --wingspan 0.7,0.035 --speed 11,1\n"
      "  flocklift reconstruct tracks.csv --camera camera.yaml --preset jackdaw --no-size\n"
      "  flocklift reconstruct tracks.csv --camera camera.yaml --near 20 --far 80 --pitch 15\n"
      "  flocklift reconstruct tracks.csv --camera camera.yaml --speed 11 --method cobyla\n"
      "  flocklift reconstruct left.csv --camera left.yaml --second-tracks right.csv "
      "--second-camera right.yaml",
      {.fps = true}, &RunReconstruct, &command);
  sub->add_option("tracks", command->tracks, "tracks (MOTChallenge CSV, or HDF5)")->required();
  sub->add_option("--camera", command->camera, "camera file")->required();
  sub->add_option("--shapes", command->shapes,
                  "shapes of the tracked animals; default: shapes.csv beside the tracks");
  sub->add_option(
         "--method", command->method,
         fmt::format(
             "auto: dynamics up to {} rows, batch beyond; batch; dynamics (batch, then with forces "
             "between the animals as far as these predict hidden sightings better; about ten times "
             "the time); cobyla (as published) or lin-ceres (the same with another optimiser)",
             kDynamicsRows))
      ->check(CLI::IsMember({"auto", "batch", "dynamics", "cobyla", "lin-ceres"}))
      ->capture_default_str();
  sub->add_option("--output", command->output, "name of the file to write; .h5 for HDF5")
      ->capture_default_str();
  AddKnowledgeFlags(*sub, command.get());
  AddFlags(*sub, command->batch, "Methods batch and dynamics");
  AddFlags(*sub, command->dynamics, "Method dynamics");
  sub->add_option("--first-depths", command->first_depths,
                  "trajectories whose depths in the first frame cobyla starts from")
      ->group("Methods cobyla and lin-ceres");
  AddFlags(*sub, command->cobyla, "Methods cobyla and lin-ceres");
}

}  // namespace flocklift
