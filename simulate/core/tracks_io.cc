// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

#include "simulate/core/animal_rows.h"
#include "simulate/core/hdf5_table.h"
#include "simulate/core/input_file.h"
#include "simulate/core/io.h"
#include "simulate/core/read_part.h"
#include "simulate/core/table_writer.h"

namespace flocklift {
namespace {

using internal::AnimalRows;
using internal::ReadCsvTable;
using internal::ReadTable;
using internal::TableContents;
using internal::TableLayout;
using internal::TableRow;

enum Column { kLeft, kTop, kWidth, kHeight, kConfidence };
constexpr int kConfidenceGroup = 1;
constexpr int kDecimals = 4;  // of a pixel
constexpr double kSmallestBox = 1e-4;

TableLayout Layout(bool may_lack_id) {
  return {
      .name = "tracks",
      .columns = {{"left"}, {"top"}, {"width"}, {"height"}, {"confidence", kConfidenceGroup, 1}},
      .has_header = false,
      .may_lack_id = may_lack_id,
      .group_count = 1};
}

Detection CheckedDetection(const TableRow& row) {
  const double* v = row.values;
  if (!(v[kWidth] > 0 && v[kHeight] > 0)) {
    row.Fail(fmt::format("the box is {:g} by {:g} pixels", v[kWidth], v[kHeight]),
             "give it a positive width and height, or take the row out");
  }
  if (!(v[kConfidence] >= 0 && v[kConfidence] <= 1)) {
    row.Fail(fmt::format("confidence is {:g}", v[kConfidence]), "scale confidences to 0 ... 1");
  }
  return {.frame = row.frame,
          .box = {v[kLeft], v[kTop], v[kWidth], v[kHeight]},
          .confidence = v[kConfidence],
          .shape = {}};
}

// `read(layout, take)` is one of the two readers of tables.
template <typename Read>
Tracks ReadTracksWith(const Read& read, bool may_be_empty = false) {
  AnimalRows<Detection> rows;
  const TableContents contents = read(Layout(false), [&](const TableRow& row) {
    rows.Add(row.id, CheckedDetection(row), row.line);
  });
  if (contents.row_count == 0 && !may_be_empty) {
    contents.place.Fail(0, "there are no rows", "give tracks that hold at least one");
  }
  Tracks tracks{.fps = contents.fps, .tracklets = {}};
  rows.Finish(contents.place, [&](Id id, std::vector<Detection> detections) {
    tracks.tracklets.push_back({id, std::move(detections)});
  });
  return tracks;
}

template <typename Read>
std::vector<DetectionFrame> ReadDetectionsWith(const Read& read) {
  std::vector<Detection> detections;
  const TableContents contents =
      read(Layout(true), [&](const TableRow& row) { detections.push_back(CheckedDetection(row)); });
  if (contents.row_count == 0) {
    contents.place.Fail(0, "there are no rows", "give detections that hold at least one");
  }
  std::stable_sort(detections.begin(), detections.end(),
                   [](const Detection& a, const Detection& b) { return a.frame < b.frame; });
  std::vector<DetectionFrame> frames;
  for (const Detection& detection : detections) {
    if (frames.empty() || frames.back().frame != detection.frame) {
      frames.push_back({detection.frame, {}});
    }
    frames.back().detections.push_back(detection);
  }
  return frames;
}

}  // namespace

std::optional<double> ForEachTrackRow(const std::filesystem::path& path,
                                      const std::function<void(const TrackRow&)>& take) {
  return ReadTable(path, Layout(true),
                   [&](const TableRow& row) {
                     take({row.id, CheckedDetection(row)});
                   })
      .fps;
}

std::optional<double> ForEachTrackRow(std::istream& stream, const std::string& name,
                                      const std::function<void(const TrackRow&)>& take) {
  return ReadCsvTable(stream, name, Layout(true),
                      [&](const TableRow& row) {
                        take({row.id, CheckedDetection(row)});
                      })
      .fps;
}

Tracks ReadTracks(const std::filesystem::path& path) {
  return ReadTracksWith(
      [&](const TableLayout& layout, const auto& take) { return ReadTable(path, layout, take); });
}

Tracks ReadTracks(std::istream& stream, const std::string& name) {
  return ReadTracksWith([&](const TableLayout& layout, const auto& take) {
    return ReadCsvTable(stream, name, layout, take);
  });
}

std::optional<Tracks> ReadTracks(const TableByFrame& table, int first, int last) {
  return internal::ReadPart(table, first, last,
                            [](const auto& read) { return ReadTracksWith(read, true); });
}

std::vector<DetectionFrame> ReadDetections(const std::filesystem::path& path) {
  return ReadDetectionsWith(
      [&](const TableLayout& layout, const auto& take) { return ReadTable(path, layout, take); });
}

std::vector<DetectionFrame> ReadDetections(std::istream& stream, const std::string& name) {
  return ReadDetectionsWith([&](const TableLayout& layout, const auto& take) {
    return ReadCsvTable(stream, name, layout, take);
  });
}

TrackWriter::TrackWriter(const std::filesystem::path& path, std::optional<double> fps,
                         bool is_truth)
    : writer_(internal::TableWriter::Create(
          path, Layout(true), {true, true}, fps,
          {.decimals = kDecimals, .end_of_row = is_truth ? ",-1,1,-1" : ",-1,-1,-1"})),
      is_truth_(is_truth) {}
TrackWriter::~TrackWriter() = default;

void TrackWriter::Add(Id id, const Detection& detection) {
  const Box& box = detection.box;
  const std::array<double, 5> values{box.left, box.top, std::max(box.width, kSmallestBox),
                                     std::max(box.height, kSmallestBox), detection.confidence};
  std::string end_of_row;
  if (is_truth_ && detection.visibility < 1) {
    end_of_row = fmt::format(",-1,{:.4g},-1", detection.visibility);
  }
  writer_->Add(detection.frame, id, values, end_of_row);
}

void TrackWriter::Commit() { writer_->Commit(); }

namespace {

void WriteAllTracks(const Tracks& tracks, TrackWriter writer) {
  internal::ForEachByFrame(
      tracks.tracklets, [](const Tracklet& t) -> const auto& { return t.detections; },
      [&](Id id, const Detection& detection) { writer.Add(id, detection); });
  writer.Commit();
}

}  // namespace

void WriteTracks(const std::filesystem::path& path, const Tracks& tracks) {
  WriteAllTracks(tracks, TrackWriter(path, tracks.fps));
}

void WriteTrueTracks(const std::filesystem::path& path, const Tracks& tracks) {
  WriteAllTracks(tracks, TrackWriter(path, tracks.fps, /*is_truth=*/true));
}

void WriteDetections(const std::filesystem::path& path, const std::vector<DetectionFrame>& frames) {
  TrackWriter writer(path, std::nullopt);
  for (const DetectionFrame& frame : frames) {
    for (const Detection& detection : frame.detections) writer.Add(kNoId, detection);
  }
  writer.Commit();
}

}  // namespace flocklift
