// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <fstream>

#include "simulate/core/animal_rows.h"
#include "simulate/core/input_file.h"
#include "simulate/core/io.h"
#include "simulate/core/table_writer.h"

namespace flocklift {
namespace {

using internal::TableLayout;
using internal::TableRow;

enum Column { kMajor, kMinor, kAngle, kArea };
constexpr int kDecimals = 4;
constexpr double kSmallest = 1e-4;  // that kDecimals can tell from 0
constexpr double kHalfTurn = 180;   // [deg]

TableLayout Layout() {
  return {.name = "shapes", .columns = {{"major"}, {"minor"}, {"angle"}, {"area"}}};
}

Shape CheckedShape(const TableRow& row) {
  const double* v = row.values;
  if (!(v[kMinor] >= 0 && v[kMajor] > 0 && v[kMajor] >= v[kMinor])) {
    row.Fail(fmt::format("the axes are {:g} and {:g} pixels", v[kMajor], v[kMinor]),
             "give major >= minor >= 0 and major > 0, or take the row out");
  }
  // Exactly 180 is what other programs round 179.999 to: the same direction as 0.
  if (!(v[kAngle] >= 0 && v[kAngle] <= kHalfTurn)) {
    row.Fail(fmt::format("angle is {:g}", v[kAngle]), "turn it by 180 degrees into [0, 180)");
  }
  if (!(v[kArea] > 0)) {
    row.Fail(fmt::format("area is {:g}", v[kArea]), "give a positive one, or take the row out");
  }
  return {v[kMajor], v[kMinor], v[kAngle] < kHalfTurn ? v[kAngle] : 0, v[kArea]};
}

Detection* FindDetection(Tracks* tracks, Id id, int frame) {
  const auto tracklet =
      std::lower_bound(tracks->tracklets.begin(), tracks->tracklets.end(), id,
                       [](const Tracklet& t, Id wanted) { return t.id < wanted; });
  if (tracklet == tracks->tracklets.end() || tracklet->id != id) return nullptr;
  const auto detection =
      std::lower_bound(tracklet->detections.begin(), tracklet->detections.end(), frame,
                       [](const Detection& d, int wanted) { return d.frame < wanted; });
  if (detection == tracklet->detections.end() || detection->frame != frame) return nullptr;
  return &*detection;
}

}  // namespace

void ReadShapes(std::istream& stream, const std::string& name, Tracks* tracks) {
  for (Tracklet& tracklet : tracks->tracklets) {
    for (Detection& detection : tracklet.detections) detection.shape.reset();
  }
  internal::ReadCsvTable(stream, name, Layout(), [&](const TableRow& row) {
    Detection* const detection = FindDetection(tracks, row.id, row.frame);
    if (detection == nullptr) {
      row.Fail(fmt::format("frame {} of id {} is not in the tracks", row.frame, row.id),
               "give the shapes that belong to these tracks, or none");
    }
    if (detection->shape) {
      row.Fail(fmt::format("frame {} of id {} has a shape already", row.frame, row.id),
               "take one of the two out");
    }
    detection->shape = CheckedShape(row);
  });
}

void ReadShapes(const std::filesystem::path& path, Tracks* tracks) {
  std::ifstream stream = OpenInput(path);
  ReadShapes(stream, path.string(), tracks);
}

ShapeWriter::ShapeWriter(const std::filesystem::path& path, std::optional<double> fps)
    : writer_(internal::TableWriter::Create(path, Layout(), {true}, fps,
                                            {.decimals = kDecimals, .end_of_row = ""})) {}
ShapeWriter::~ShapeWriter() = default;

void ShapeWriter::Add(Id id, const Detection& detection) {
  if (!detection.shape) return;
  const Shape& shape = *detection.shape;
  // An angle that would round to 180 is 0.
  const bool wraps = shape.angle_deg > kHalfTurn - 0.5 * kSmallest;
  const std::array<double, 4> values{std::max(shape.major, kSmallest), shape.minor,
                                     wraps ? 0 : shape.angle_deg, std::max(shape.area, kSmallest)};
  writer_->Add(detection.frame, id, values);
}

void ShapeWriter::Commit() { writer_->Commit(); }

void WriteShapes(const std::filesystem::path& path, const Tracks& tracks) {
  ShapeWriter writer(path, tracks.fps);
  internal::ForEachByFrame(
      tracks.tracklets, [](const Tracklet& t) -> const auto& { return t.detections; },
      [&](Id id, const Detection& detection) { writer.Add(id, detection); });
  writer.Commit();
}

}  // namespace flocklift
