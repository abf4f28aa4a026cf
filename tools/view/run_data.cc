// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/run_data.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "tools/view/camera_json.h"
#include "tools/view/solve_options.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kCorrections = "corrections.txt";
constexpr std::size_t kFirstRows = 8000;     // of a large flock, looked at before it is shown
constexpr std::size_t kCurveRows = 2000000;  // of one in memory, that curves are drawn of
constexpr std::int64_t kMostFrames = 4096;   // of a large file at a time

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
Json BoundsOf(const TrajectoryTable& table) {
  if (table.rows.animal.empty()) return nullptr;
  Json low = Json::array(), high = Json::array();
  const std::size_t n = table.rows.animal.size(), stride = 1 + n / 100000;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (std::size_t row = 0; row < n; row += stride) {
      values.push_back(table.position[3 * row + axis]);
    }
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / 200;
    low.push_back(values[cut]);
    high.push_back(values[values.size() - 1 - cut]);
  }
  return {{"low", low}, {"high", high}};
}

// A flock of a file: the rows, or the file where they are.
struct Opened {
  std::optional<TableByFrame> file = {};
  std::optional<Trajectories> whole = {};
  std::optional<double> fps = {};
};

// What a large file says of itself before its rows; nothing when it is damaged there.
template <typename Read>
std::optional<double> FpsOf(const Read& read_nothing) {
  try {
    const auto head = read_nothing();
    return head ? head->fps : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Opened OpenFlock(const fs::path& path, std::uint64_t large_bytes) {
  Opened opened;
  if (path.empty()) return opened;
  opened.file = OpenLarge(path, "trajectories", large_bytes);
  if (opened.file) {
    opened.fps = FpsOf([&] { return ReadTrajectories(*opened.file, 0, 0); });
  } else {
    opened.whole = ReadTrajectories(path);
    opened.fps = opened.whole->fps;
  }
  return opened;
}

std::optional<FlockRows> RowsOf(Opened opened, std::optional<double> fps) {
  if (opened.file) return FlockRows(std::move(*opened.file), fps);
  if (opened.whole) return FlockRows(std::move(*opened.whole), fps);
  return std::nullopt;
}

}  // namespace

RunData::RunData(const RunDataOptions& options)
    : run_(ReadRunFolder(options.folder, options.truth, options.fps, /*reads_tables=*/false)) {
  OpenTables(options);
  OpenFootage();
  OpenEditor();
}

void RunData::OpenTables(const RunDataOptions& options) {
  const RunTables& files = run_.tables;
  if (files.tracks.empty()) {
    no_tracks_ = "The folder holds no tracks.";
  } else if ((track_file_ = OpenLarge(files.tracks, "tracks", options.large_bytes))) {
    tracks_fps_ = FpsOf([&] { return ReadTracks(*track_file_, 0, 0); });
    no_tracks_ = "The tracks are still being read.";
  } else {
    Tracks tracks = ReadTracks(files.tracks);
    if (!files.shapes.empty()) ReadShapes(files.shapes, &tracks);
    tracks_fps_ = tracks.fps;
    tracks_ = Shared(std::move(tracks));
    for (const auto& t : tracks_) animals_.Add(t->id);
  }
  Opened before = OpenFlock(files.trajectories, options.large_bytes);
  Opened truth = OpenFlock(files.true_trajectories, options.large_bytes);
  const std::optional<double> camera_fps = run_.camera ? run_.camera->fps : std::nullopt;
  run_.fps = options.fps;
  for (const auto& fps : {before.fps, tracks_fps_, camera_fps, truth.fps}) {
    if (!run_.fps) run_.fps = fps;
  }
  for (auto& [opened, flock] : {std::pair(&before, &before_), std::pair(&truth, &truth_)}) {
    auto rows = RowsOf(std::move(*opened), run_.fps);
    if (!rows) continue;
    const TrajectoryTable curves = CurvesOf(rows->Sample(rows->file() ? kFirstRows : kCurveRows));
    flock->emplace(Flock{std::move(*rows), curves});
  }
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
  no_editor_ = no_tracks_;
  if (!no_tracks_.empty()) return;
  try {
    auto [path, sha256] = CorrectionsOf(run_);
    if (path.empty()) path = run_.folder / kCorrections;
    int last = 0;
    for (const auto& t : tracks_) last = std::max(last, t->detections.back().frame);
    editor_ = std::make_unique<TrackEditor>(tracks_, tracks_fps_,
                                            footage_ ? footage_->frame_count() : last,
                                            ReadCorrectionsFile(path, sha256));
    TracksChanged();
  } catch (const InputError& error) {
    no_editor_ = error.what();
  }
}

const std::optional<RunData::Flock>& RunData::Find(const std::string& what) const {
  Check(what == "after" || what == "truth" || what == "before", "there is no flock " + what);
  return what == "after" ? after_ : what == "truth" ? truth_ : before_;
}

template <typename Rows>
std::string RunData::Packed(const Rows& rows, int first, int last) const {
  {
    const std::unique_lock lock(animals_mutex_);
    animals_.Add(rows);
  }
  const std::shared_lock lock(animals_mutex_);
  return PackWindow(TableOf(rows, animals_), first, last);
}

std::string RunData::Window(const std::string& what, int first, int last) const {
  const bool is_boxes = what == "boxes";
  const auto& flock = is_boxes ? before_ : Find(what);
  if (is_boxes ? track_file_.has_value() : flock && flock->rows.file()) {
    Check(std::int64_t{last} - first < kMostFrames, "ask for fewer frames at a time");
  }
  // A file that turns out not to be by frame is read whole later; until then there is nothing.
  if (is_boxes) {
    return Packed(track_file_ ? ReadTracks(*track_file_, first, last).value_or(Tracks{})
                              : Cut(tracks_, first, last),
                  first, last);
  }
  return Packed(flock ? flock->rows.Rows(first, last).value_or(Trajectories{}) : Trajectories{},
                first, last);
}

const TrajectoryTable& RunData::Curves(const std::string& what) const {
  static const TrajectoryTable kNone{};
  const auto& flock = Find(what);
  return flock ? flock->curves : kNone;
}

const FlockRows* RunData::FlockOf(const std::string& what) const {
  const auto& flock = Find(what);
  return flock ? &flock->rows : nullptr;
}

TrajectoryTable RunData::CurvesOf(const Trajectories& sample) const {
  AnimalList animals;  // by itself: the background, which calls this, must not hold up windows
  {
    const std::unique_lock lock(animals_mutex_);
    animals_.Add(sample);
    animals = animals_;
  }
  return TableOf(sample, animals);
}

void RunData::SetTracks(Tracks tracks) {
  tracks_ = Shared(std::move(tracks));
  track_file_.reset();
  no_tracks_.clear();
  OpenEditor();
  if (!editor_) ++boxes_version_;
}

void RunData::SetNoTracks(const std::string& reason) { no_tracks_ = no_editor_ = reason; }

void RunData::SetFlock(const std::string& what, FlockRows rows) {
  const TrajectoryTable curves = CurvesOf(rows.Sample(kCurveRows));
  (what == "truth" ? truth_ : before_).emplace(Flock{std::move(rows), curves});
  ++before_version_;
  ++curves_version_;
}

void RunData::SetCurves(const std::string& what, TrajectoryTable curves) {
  (what == "truth" ? truth_ : before_)->curves = std::move(curves);
  ++curves_version_;
}

void RunData::AddAnimals(const std::vector<Id>& ids) const {
  const std::unique_lock lock(animals_mutex_);
  for (const Id id : ids) animals_.Add(id);
}

std::size_t RunData::animal_count() const {
  const std::shared_lock lock(animals_mutex_);
  return animals_.ids().size();
}

ReconstructCommand RunData::Command() const {
  ReconstructCommand start;
  start.method = "batch";
  const fs::path& tracks = run_.tables.tracks;
  start.tracks = tracks.empty() ? run_.folder / "tracks.csv" : tracks;
  start.camera = run_.camera_file;
  const Json* summary = SummaryOf(run_, "reconstruct");
  if (summary == nullptr || !summary->contains("options")) return start;
  try {
    ReconstructCommand command = start;
    TakeSolveOptions(summary->at("options"), &command);
    return command;
  } catch (const std::invalid_argument&) {
    return start;  // of another version: the defaults
  }
}

const TrackList& RunData::CurrentTracks() const {
  Check(no_tracks_.empty(), no_tracks_);
  return tracks_;
}

std::vector<Correction> RunData::Corrections() const {
  return editor_ ? editor_->Corrections() : std::vector<Correction>();
}

const Json& RunData::TrackerDoubts() const { return run_.Figure("track", "suspicious"); }

TrackEditor& RunData::editor() {
  Check(editor_ != nullptr, no_editor_);
  return *editor_;
}

void RunData::TracksChanged() {
  tracks_ = editor_->Current();
  const std::unique_lock lock(animals_mutex_);
  for (const auto& t : tracks_) animals_.Add(t->id);
  ++boxes_version_;
}

void RunData::SetSolved(const Trajectories& trajectories) {
  FlockRows rows(trajectories, run_.fps);
  const TrajectoryTable curves = CurvesOf(rows.Sample(kCurveRows));
  after_.emplace(Flock{std::move(rows), curves});
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
  if (track_file_) take(track_file_->first_frame(), track_file_->last_frame());
  for (const auto& t : tracks_) take(t->detections.front().frame, t->detections.back().frame);
  if (before_) take(before_->rows.span().first, before_->rows.span().last);
  if (footage_) take(1, footage_->frame_count());
  return span;
}

Json RunData::Versions() const {
  const std::shared_lock lock(animals_mutex_);
  Json ids = Json::array();
  for (const Id id : animals_.ids()) ids.push_back(std::to_string(id));
  return {{"boxes", boxes_version_},
          {"before", before_version_},
          {"after", after_version_},
          {"curves", curves_version_},
          {"animals", ids}};
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
                {{"boxes", track_file_ || !tracks_.empty()},
                 {"before", before_.has_value()},
                 {"truth", truth_.has_value()},
                 {"sd", before_ && before_->rows.has_sd_depth()}}},
               {"bounds", BoundsOf(Curves(before_ ? "before" : "truth"))}};
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
                   {"reason", run_.tables.tracks.empty() ? "The folder holds no tracks to solve."
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
