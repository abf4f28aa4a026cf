// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/run_data.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulate/core/check.h"
#include "tools/view/camera_json.h"
#include "tools/view/solve_options.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kCorrections = "corrections.txt";

const Json* SummaryOf(const RunFolder& run, const std::string& stage) {
  for (const StageSummary& summary : run.summaries) {
    if (summary.stage == stage && summary.json.is_object()) return &summary.json;
  }
  return nullptr;
}

// The corrections among the inputs of `track`: its second input, if there are two.
std::pair<fs::path, std::string> CorrectionsOf(const RunFolder& run) {
  const Json* summary = SummaryOf(run, "track");
  if (summary == nullptr || !summary->contains("inputs") || !summary->at("inputs").is_array() ||
      summary->at("inputs").size() < 2) {
    return {};
  }
  const Json& input = summary->at("inputs").at(1);
  if (!input.is_object() || !input.contains("name") || !input.at("name").is_string()) return {};
  return {input.at("name").get<std::string>(), input.value("sha256", "")};
}

// A box around nearly all rows: strays that are far away would hide the flock.
Json BoundsOf(const TrajectoryTable* table) {
  if (table == nullptr || table->rows.animal.empty()) return nullptr;
  Json low = Json::array(), high = Json::array();
  const std::size_t n = table->rows.animal.size(), stride = 1 + n / 100000;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (std::size_t row = 0; row < n; row += stride) {
      values.push_back(table->position[3 * row + axis]);
    }
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / 200;
    low.push_back(values[cut]);
    high.push_back(values[values.size() - 1 - cut]);
  }
  return {{"low", low}, {"high", high}};
}

}  // namespace

RunData::RunData(const fs::path& folder, const std::optional<fs::path>& truth,
                 std::optional<double> fps)
    : run_(ReadRunFolder(folder, truth, fps)) {
  if (run_.tracks) {
    for (const Tracklet& t : run_.tracks->tracklets) animals_.Add(t.id);
  }
  for (const auto* paths : {&run_.trajectories, &run_.true_trajectories}) {
    if (!*paths) continue;
    for (const Trajectory& t : (*paths)->trajectories) animals_.Add(t.id);
  }
  OpenFootage();
  OpenEditor();
  if (editor_) {
    TracksChanged();
  } else if (run_.tracks) {
    boxes_ = TableOf(*run_.tracks, animals_);
  }
  if (run_.trajectories) before_ = TableOf(*run_.trajectories, animals_);
  if (run_.true_trajectories) truth_ = TableOf(*run_.true_trajectories, animals_);
}

void RunData::OpenFootage() {
  if (!run_.video) {
    no_footage_ = "The folder does not say which film was tracked, or it is not there any more.";
    return;
  }
  try {
    footage_ = std::make_shared<Footage>(*run_.video);
  } catch (const InputError& error) {
    no_footage_ = error.what();
  }
}

void RunData::OpenEditor() {
  if (!run_.tracks) {
    no_editor_ = "The folder holds no tracks.";
    return;
  }
  try {
    auto [path, sha256] = CorrectionsOf(run_);
    if (path.empty()) path = run_.folder / kCorrections;
    const int frames = footage_ ? footage_->frame_count() : SpanOf(*run_.tracks).last;
    editor_ =
        std::make_unique<TrackEditor>(*run_.tracks, frames, ReadCorrectionsFile(path, sha256));
  } catch (const InputError& error) {
    no_editor_ = error.what();
  }
}

const TrajectoryTable* RunData::Table(const std::string& what) const {
  const auto& table = what == "after" ? after_ : what == "truth" ? truth_ : before_;
  Check(what == "after" || what == "truth" || what == "before", "there is no table " + what);
  return table ? &*table : nullptr;
}

ReconstructCommand RunData::Command() const {
  ReconstructCommand command;
  command.tracks = run_.folder / "tracks.csv";
  command.camera = run_.camera_file;
  const Json* summary = SummaryOf(run_, "reconstruct");
  if (summary != nullptr && summary->contains("options")) {
    try {
      TakeSolveOptions(summary->at("options"), &command);
    } catch (const std::invalid_argument&) {
      command = {};  // of another version: the defaults
      command.tracks = run_.folder / "tracks.csv";
      command.camera = run_.camera_file;
    }
  }
  return command;
}

Tracks RunData::CurrentTracks() const {
  Check(run_.tracks.has_value(), "the folder holds no tracks to solve");
  return editor_ ? editor_->Result() : *run_.tracks;
}

TrackEditor& RunData::editor() {
  Check(editor_ != nullptr, no_editor_);
  return *editor_;
}

void RunData::TracksChanged() {
  const Tracks tracks = editor_->Result();
  for (const Tracklet& t : tracks.tracklets) animals_.Add(t.id);
  boxes_ = TableOf(tracks, animals_);
  ++boxes_version_;
}

void RunData::SetSolved(const Trajectories& trajectories) {
  for (const Trajectory& t : trajectories.trajectories) animals_.Add(t.id);
  after_ = TableOf(trajectories, animals_);
  ++after_version_;
}

FrameSpan RunData::Span() const {
  FrameSpan span;
  const auto take = [&span](int first, int last) {
    if (last < first) return;
    span = span.last < span.first
               ? FrameSpan{first, last}
               : FrameSpan{std::min(span.first, first), std::max(span.last, last)};
  };
  take(boxes_.rows.first_frame, boxes_.rows.last_frame());
  if (before_) take(before_->rows.first_frame, before_->rows.last_frame());
  if (footage_) take(1, footage_->frame_count());
  return span;
}

Json RunData::Versions() const {
  Json ids = Json::array();
  for (const Id id : animals_.ids()) ids.push_back(std::to_string(id));
  return {{"boxes", boxes_version_}, {"after", after_version_}, {"animals", ids}};
}

Json RunData::Edits() const {
  if (!editor_) return {{"reason", no_editor_}, {"lines", Json::array()}, {"redo", 0}};
  return {{"reason", ""}, {"lines", editor_->Lines()}, {"redo", editor_->redo_count()}};
}

Json RunData::Session() const {
  const FrameSpan span = Span();
  std::string name = fs::canonical(run_.folder).filename().string();
  Json json = {{"kind", "run"},
               {"name", name},
               {"fps", run_.fps ? Json(*run_.fps) : Json(nullptr)},
               {"frames", {{"first", span.first}, {"last", span.last}}},
               {"versions", Versions()},
               {"has",
                {{"boxes", !boxes_.rows.animal.empty()},
                 {"before", before_ && !before_->rows.animal.empty()},
                 {"truth", truth_ && !truth_->rows.animal.empty()},
                 {"sd", run_.trajectories && run_.trajectories->has_sd_depth}}},
               {"bounds", BoundsOf(before_  ? &*before_
                                   : truth_ ? &*truth_
                                            : nullptr)}};
  json["camera"] = run_.camera ? CameraAsJson(*run_.camera) : Json(nullptr);
  json["footage"] = nullptr;
  if (footage_) {
    json["footage"] = {{"width", footage_->width()},
                       {"height", footage_->height()},
                       {"frames", footage_->frame_count()},
                       {"video", !footage_->file().empty()}};
  }
  json["noFootage"] = no_footage_;
  json["edits"] = Edits();
  const ReconstructCommand command = Command();
  json["solve"] = {{"values", SolveOptionsAsJson(command)},
                   {"options", DescribeSolveOptions(command)},
                   {"command", CommandLineOf(command)},
                   {"reason", !run_.tracks   ? "The folder holds no tracks to solve."
                              : !run_.camera ? "The folder says no camera: depth cannot be solved."
                              : !run_.fps    ? "Nothing says how many frames a second has: --fps."
                                             : ""}};
  const Json* summary = SummaryOf(run_, "reconstruct");
  json["observability"] = summary != nullptr && summary->contains("figures")
                              ? summary->at("figures").value("observability", "")
                              : "";
  return json;
}

}  // namespace flocklift
