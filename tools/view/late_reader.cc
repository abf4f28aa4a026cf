// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/late_reader.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/io.h"

namespace flocklift {
namespace {

constexpr int kPart = 16;                    // frames read at a time
constexpr std::size_t kCurveRows = 300'000;  // several a pixel of the curves

// Calls read(first, last) for all frames of the file in parts; false when one of them says that
// they are not by frame.
template <typename Read>
bool ForEachPart(const TableByFrame& file, const Progress& progress, const Read& read) {
  const int first = file.first_frame(), last = file.last_frame();
  for (int frame = first; frame <= last; frame += kPart) {
    progress(frame - first, last - first + 1);
    if (!read(frame, std::min(frame + kPart - 1, last))) return false;
  }
  return true;
}

}  // namespace

std::optional<Tracks> ReadAllTracks(const TableByFrame& file, const Progress& progress) {
  Tracks all;
  std::map<Id, Tracklet> animals;
  const bool is_by_frame = ForEachPart(file, progress, [&](int first, int last) {
    const auto part = ReadTracks(file, first, last);
    if (!part) return false;
    all.fps = part->fps;
    for (const Tracklet& t : part->tracklets) {
      Tracklet& mine = animals.try_emplace(t.id, Tracklet{t.id, {}}).first->second;
      mine.detections.insert(mine.detections.end(), t.detections.begin(), t.detections.end());
    }
    return true;
  });
  if (!is_by_frame) return std::nullopt;
  for (auto& [id, tracklet] : animals) {
    tracklet.detections.shrink_to_fit();
    all.tracklets.push_back(std::move(tracklet));
  }
  return all;
}

std::optional<std::vector<Id>> ReadAllIds(const TableByFrame& file, const Progress& progress) {
  std::set<Id> ids;
  const bool is_by_frame = ForEachPart(file, progress, [&](int first, int last) {
    const auto part = ReadTrajectories(file, first, last);
    if (!part) return false;
    for (const Trajectory& t : part->trajectories) ids.insert(t.id);
    return true;
  });
  if (!is_by_frame) return std::nullopt;
  return std::vector<Id>(ids.begin(), ids.end());
}

void LateReader::Run(const Progress& alive) {
  for (const char* what : {"before", "truth"}) DrawCurves(what, alive);
  TakeTracks(alive);
  for (const char* what : {"before", "truth"}) CheckFlock(what, alive);
  Tell("");
}

void LateReader::DrawCurves(const std::string& what, const Progress& alive) {
  std::optional<FlockRows> rows;
  {
    const std::shared_lock lock(*mutex_);
    const FlockRows* flock = data_->FlockOf(what);
    if (flock == nullptr || !flock->file()) return;
    rows = *flock;
  }
  const Trajectories sample = rows->Sample(kCurveRows, Telling("Reading for the curves", alive));
  TrajectoryTable curves = data_->CurvesOf(sample);
  Change([&](RunData* data) { data->SetCurves(what, std::move(curves)); });
}

void LateReader::TakeTracks(const Progress& alive) {
  std::optional<TableByFrame> file;
  std::filesystem::path shapes;
  {
    const std::shared_lock lock(*mutex_);
    file = data_->track_file();
    shapes = data_->run().tables.shapes;
  }
  if (!file) return;
  const std::string words = "Reading the tracks, to mend and to solve";
  try {
    std::optional<Tracks> tracks = ReadAllTracks(*file, Telling(words, alive));
    if (!tracks) tracks = ReadTracks(file->path());
    if (!shapes.empty()) ReadShapes(shapes, &*tracks);
    Change([&](RunData* data) { data->SetTracks(std::move(*tracks)); });
  } catch (const InputError& error) {
    Change([&](RunData* data) { data->SetNoTracks(error.what()); });
    TellFault(error.what());
  }
}

void LateReader::CheckFlock(const std::string& what, const Progress& alive) {
  std::optional<TableByFrame> file;
  std::optional<double> fps;
  {
    const std::shared_lock lock(*mutex_);
    const FlockRows* flock = data_->FlockOf(what);
    if (flock != nullptr) file = flock->file();
    fps = data_->run().fps;
  }
  if (!file) return;
  try {
    const auto ids = ReadAllIds(*file, Telling("Checking the trajectories", alive));
    if (ids) {
      Change([&](RunData* data) { data->AddAnimals(*ids); });
    } else {
      FlockRows rows(ReadTrajectories(file->path()), fps);
      Change([&](RunData* data) { data->SetFlock(what, std::move(rows)); });
    }
  } catch (const InputError& error) {
    TellFault(error.what());
  }
}

Progress LateReader::Telling(const std::string& words, const Progress& alive) {
  return [this, words, alive](std::int64_t done, std::int64_t total) {
    alive(done, total);
    Tell(words + ": " + std::to_string(100 * done / std::max<std::int64_t>(total, 1)) + " %");
  };
}

void LateReader::Tell(const std::string& text) {
  if (text == text_ && !text.empty()) return;
  text_ = text;
  bus_->Publish("reading", {{"text", text}, {"faults", faults_}});
}

void LateReader::TellFault(const std::string& fault) {
  faults_.push_back(fault);
  bus_->Publish("reading", {{"text", text_}, {"faults", faults_}});
}

template <typename Work>
void LateReader::Change(const Work& work) {
  nlohmann::ordered_json versions, edits;
  {
    const std::unique_lock lock(*mutex_);
    work(data_);
    versions = data_->Versions();
    edits = data_->Edits();
  }
  bus_->Publish("data", versions);
  bus_->Publish("edits", edits);
}

}  // namespace flocklift
