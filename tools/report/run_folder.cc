// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report/run_folder.h"

#include <array>
#include <fstream>

#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/input_file.h"
#include "simulate/core/io.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::array kStages = {"simulate", "track", "reconstruct", "fit", "replay", "evaluate"};
constexpr const char* kReplay = "replay";  // a folder in that of the run, with a film of its own

Json ReadJson(const fs::path& path) {
  std::ifstream file(path);
  Json json = Json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!file.is_open() || json.is_discarded()) {
    throw InputError(path.string(), 0, "is no JSON", "run the command that made it again");
  }
  return json;
}

// The first of the files that is there; notes it among the files read.
std::optional<fs::path> Find(const std::vector<fs::path>& candidates, RunFolder* run) {
  for (const fs::path& path : candidates) {
    if (!fs::is_regular_file(path)) continue;
    run->files.push_back(path);
    return path;
  }
  return std::nullopt;
}

void ReadSummaries(const std::vector<fs::path>& folders, RunFolder* run) {
  for (const char* stage : kStages) {
    for (const fs::path& folder : folders) {
      const auto path = Find({folder / (std::string("summary.") + stage + ".json")}, run);
      if (!path) continue;
      run->summaries.push_back({stage, ReadJson(*path)});
      break;
    }
  }
}

// The inputs of a stage, as paths that may have been relative to the folder where it ran: most
// likely one above that of the run.
std::vector<fs::path> InputsOf(const RunFolder& run, const std::string& stage) {
  std::vector<fs::path> paths;
  std::vector<fs::path> bases = {"", run.folder};
  for (fs::path above = fs::canonical(run.folder); above.has_relative_path();) {
    above = above.parent_path();
    bases.push_back(above);
  }
  for (const StageSummary& summary : run.summaries) {
    if (summary.stage != stage || !summary.json.is_object()) continue;
    const Json inputs = summary.json.value("inputs", Json::array());
    if (!inputs.is_array()) continue;
    for (const Json& input : inputs) {
      if (!input.is_object() || !input.contains("name") || !input["name"].is_string()) continue;
      const fs::path name = input["name"].get<std::string>();
      for (const fs::path& base : bases) paths.push_back(base / name);
      paths.push_back(run.folder / name.filename());
    }
  }
  return paths;
}

std::optional<fs::path> FindCamera(const std::vector<fs::path>& folders, RunFolder* run) {
  std::vector<fs::path> candidates;
  candidates.push_back(run->folder / "camera.yaml");
  for (const char* stage : {"reconstruct", "replay"}) {
    for (const fs::path& path : InputsOf(*run, stage)) {
      if (path.extension() == ".yaml" || path.extension() == ".yml") candidates.push_back(path);
    }
  }
  for (const fs::path& folder : folders) candidates.push_back(folder / "camera.yaml");
  return Find(candidates, run);
}

std::optional<fs::path> FindVideo(const std::vector<fs::path>& folders, const RunFolder& run) {
  std::vector<fs::path> candidates;
  for (const fs::path& path : InputsOf(run, "track")) {
    if (path.extension() != ".txt") candidates.push_back(path);  // corrections are no footage
  }
  for (const fs::path& folder : folders) {
    if (folder != run.folder / kReplay) candidates.push_back(folder / "video.mp4");
  }
  for (const fs::path& path : candidates) {
    std::error_code error;
    if (!path.empty() && fs::exists(path, error)) return path;
  }
  return std::nullopt;
}

std::vector<fs::path> CsvOrHdf5(const fs::path& folder, const std::string& stem) {
  return {folder / (stem + ".csv"), folder / (stem + ".h5")};
}

fs::path FindTable(const fs::path& folder, const std::string& stem, RunFolder* run) {
  return Find(CsvOrHdf5(folder, stem), run).value_or(fs::path());
}

std::optional<Trajectories> ReadPaths(const fs::path& path) {
  if (path.empty()) return std::nullopt;
  return ReadTrajectories(path);
}

void ReadTables(const fs::path& truth, RunFolder* run) {
  const RunTables& tables = run->tables;
  if (!tables.tracks.empty()) {
    run->tracks = ReadTracks(tables.tracks);
    if (!tables.shapes.empty()) ReadShapes(tables.shapes, &*run->tracks);
  }
  run->trajectories = ReadPaths(tables.trajectories);
  run->replay = ReadPaths(FindTable(run->folder / kReplay, "trajectories", run));
  run->true_trajectories = ReadPaths(tables.true_trajectories);
  if (truth.empty()) return;
  const fs::path true_tracks = FindTable(truth, "tracks_true", run);
  if (!true_tracks.empty()) run->true_tracks = ReadTracks(true_tracks);
}

// The first folder that holds a truth; empty when none does.
fs::path FindTruth(const std::vector<fs::path>& candidates) {
  for (const fs::path& folder : candidates) {
    for (const char* name : {"trajectories.csv", "trajectories.h5", "tracks_true.csv"}) {
      if (fs::is_regular_file(folder / name)) return folder;
    }
  }
  return {};
}

void FillVelocities(double fps, std::optional<Trajectories>* trajectories) {
  if (*trajectories && !(*trajectories)->has_velocity) {
    ComputeVelocities(fps, &trajectories->value());
  }
}

}  // namespace

const Json& RunFolder::Figure(const std::string& stage, const std::string& name) const {
  static const Json kNone;
  for (const StageSummary& summary : summaries) {
    if (summary.stage != stage || !summary.json.is_object()) continue;
    const auto figures = summary.json.find("figures");
    if (figures == summary.json.end() || !figures->is_object()) continue;
    const auto figure = figures->find(name);
    if (figure != figures->end()) return *figure;
  }
  return kNone;
}

double RunFolder::TimeOf(int frame) const { return fps ? (frame - 1) / *fps : frame; }

const char* RunFolder::TimeLabel() const { return fps ? "time [s]" : "frame"; }

RunFolder ReadRunFolder(const fs::path& folder, const std::optional<fs::path>& truth_given,
                        std::optional<double> fps, bool reads_tables) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder.string(), 0, "is no folder", "give the folder of a run");
  }
  if (truth_given && !fs::is_directory(*truth_given)) {
    throw InputError(truth_given->string(), 0, "is no folder", "give the folder of the truth");
  }
  RunFolder run;
  run.folder = folder;
  std::error_code ignored;
  const fs::path parent = fs::canonical(folder).parent_path();
  const fs::path truth =
      truth_given ? *truth_given : FindTruth({folder / "truth", parent / "truth"});
  std::vector<fs::path> folders = {folder, folder / kReplay};
  if (!truth.empty()) folders.push_back(truth);
  // A round trip keeps its scores above truth and result.
  const bool is_round_trip = !truth.empty() && fs::equivalent(truth, parent / "truth", ignored);
  if (is_round_trip) folders.push_back(parent);

  ReadSummaries(folders, &run);
  if (const auto path = FindCamera(folders, &run)) {
    run.camera = ReadCamera(*path);
    run.camera_file = *path;
  }
  run.tables.tracks = FindTable(folder, "tracks", &run);
  if (!run.tables.tracks.empty()) run.tables.shapes = FindTable(folder, "shapes", &run);
  run.tables.trajectories = FindTable(folder, "trajectories", &run);
  if (const auto path = Find({folder / "parameters.toml"}, &run)) {
    run.parameters = ReadParameters(*path);
  }
  if (const auto path = Find({folder / "kernels.svg"}, &run)) {
    run.kernels_picture = ReadTextFile(*path);
  }
  if (const auto path = Find({folder / "kernels.csv"}, &run)) {
    run.kernels_table = ReadTextFile(*path);
  }
  if (!truth.empty()) run.tables.true_trajectories = FindTable(truth, "trajectories", &run);
  std::vector<fs::path> scores = {folder / "scores.json"};
  if (is_round_trip) scores.push_back(parent / "scores.json");
  if (const auto path = Find(scores, &run)) run.scores = ReadJson(*path);
  if (run.tables.tracks.empty() && run.tables.trajectories.empty()) {
    throw InputError(folder.string(), 0, "holds neither tracks.csv nor trajectories.csv",
                     "give the folder that `flocklift run`, `track` or `reconstruct` wrote");
  }
  if (reads_tables) ReadTables(truth, &run);
  run.video = FindVideo(folders, run);

  run.fps = fps;
  if (!run.fps && run.trajectories) run.fps = run.trajectories->fps;
  if (!run.fps && run.tracks) run.fps = run.tracks->fps;
  if (!run.fps && run.camera) run.fps = run.camera->fps;
  if (!run.fps && run.true_trajectories) run.fps = run.true_trajectories->fps;
  if (run.fps) {
    for (auto* paths : {&run.trajectories, &run.replay, &run.true_trajectories}) {
      FillVelocities(*run.fps, paths);
    }
  }
  return run;
}

}  // namespace flocklift
