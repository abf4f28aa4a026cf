// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/interchange/foreign_layouts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/core/text.h"

namespace flocklift::internal {
namespace {

using Column = std::optional<std::size_t>;

Column FirstOf(const ForeignTable& table, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const Column column = table.Find(name)) return column;
  }
  return std::nullopt;
}

// A cell; nothing where the column or the value is missing.
std::optional<double> At(const ForeignRow& row, const Column& column) {
  return column ? row[*column] : std::nullopt;
}

// left, top, width, height, with names or in MOTChallenge's order.
struct BoxColumns {
  Column frame, id, left, top, width, height, confidence;
};

void ReadBoxes(ForeignTable* table, const BoxColumns& c, const TakeForeignPoint& take) {
  ForeignRow row;
  while (table->Next(&row)) {
    for (const Column& column : {c.frame, c.left, c.top, c.width, c.height}) {
      if (At(row, column)) continue;
      table->Fail(table->line(), "field " + std::to_string(*column + 1) + " is missing",
                  "give frame, id, left, top, width and height, or take the row out");
    }
    const double confidence = At(row, c.confidence).value_or(1);
    if (confidence == 0) continue;
    ForeignPoint point;
    point.frame = *row[*c.frame];
    point.id = At(row, c.id).value_or(kNoId);
    point.width = *row[*c.width];
    point.height = *row[*c.height];
    if (!(point.width > 0 && point.height > 0)) {
      table->Fail(table->line(), "the box has no size", "give it a positive width and height");
    }
    point.x = *row[*c.left] + 0.5 * point.width;
    point.y = *row[*c.top] + 0.5 * point.height;
    point.confidence = confidence;
    take(point, table->line());
  }
}

// A row an animal and frame. Frames and ids count from 0.
struct PointColumns {
  Column frame, id, x, y;
  Column missing = {}, area = {}, radius = {}, probability = {}, time = {};
};

void ReadPoints(ForeignTable* table, const PointColumns& c, Id file_id,
                const TakeForeignPoint& take) {
  ForeignRow row;
  while (table->Next(&row)) {
    const auto x = At(row, c.x), y = At(row, c.y);
    if (!x || !y || At(row, c.missing).value_or(0) != 0) continue;
    ForeignPoint point;
    const auto frame = At(row, c.frame);
    if (!frame) table->Fail(table->line(), "the frame is missing", "take the row out");
    point.frame = *frame + 1;
    point.id = static_cast<double>(file_id);
    if (c.id) {
      const auto id = At(row, c.id);
      if (!id) continue;  // not linked
      point.id = *id + 1;
    }
    point.x = *x;
    point.y = *y;
    // A disc of that area, or of that radius of gyration: 4 standard deviations are wide.
    const double area = At(row, c.area).value_or(0), radius = At(row, c.radius).value_or(0);
    if (area > 0) point.width = point.height = 2 * std::sqrt(area / std::numbers::pi);
    if (radius > 0) point.width = point.height = 2 * std::numbers::sqrt2 * radius;
    // A probability of the identity: the position was seen.
    point.confidence = 0.5 + 0.5 * std::clamp(At(row, c.probability).value_or(1), 0.0, 1.0);
    point.time = At(row, c.time);
    take(point, table->line());
  }
}

// A row a frame, two columns an animal.
struct WideColumns {
  Column time;
  std::vector<std::pair<std::size_t, std::size_t>> animals;
  double first_pixel = 0;  // where the file has the first pixel's centre
};

void ReadWide(ForeignTable* table, const WideColumns& c, const TakeForeignPoint& take) {
  ForeignRow row;
  for (double frame = 1; table->Next(&row); ++frame) {
    for (std::size_t k = 0; k < c.animals.size(); ++k) {
      const auto x = row[c.animals[k].first], y = row[c.animals[k].second];
      if (!x || !y) continue;
      ForeignPoint point;
      point.frame = frame;
      point.id = static_cast<double>(k) + 1;
      point.x = *x - c.first_pixel;
      point.y = *y - c.first_pixel;
      point.time = At(row, c.time);
      take(point, table->line());
    }
  }
}

// prefix1suffix_x, prefix1suffix_y, prefix2suffix_x, ... as long as they go on.
WideColumns FindWide(const ForeignTable& table, const std::string& before_x,
                     const std::string& before_y, const std::string& after_x,
                     const std::string& after_y) {
  WideColumns wide;
  for (int k = 1;; ++k) {
    const std::string number = std::to_string(k);
    const Column x = table.Find(before_x + number + after_x);
    const Column y = table.Find(before_y + number + after_y);
    if (!x || !y) return wide;
    wide.animals.emplace_back(*x, *y);
  }
}

std::string NamesFound(const ForeignTable& table) {
  if (table.names().empty()) {
    return "there are no names and " + std::to_string(table.column_count()) + " columns";
  }
  std::string names;
  for (const std::string& name : table.names()) names += (names.empty() ? "" : ",") + name;
  return "the columns are " + Quoted(names);
}

[[noreturn]] void FailUnknown(const ForeignTable& table) {
  table.Fail(1, NamesFound(table),
             "give one of MOTChallenge (frame,id,left,top,width,height), TRex (frame,X,Y), "
             "idtracker.ai (time,x1,y1,... or frame,time,individual,x,y), trackpy "
             "(x,y,frame[,particle] and mass or size) or DLTdv (pt1_cam1_X,pt1_cam1_Y,...)");
}

}  // namespace

std::string ReadForeignPoints(ForeignTable* table, const ForeignOptions& options, Id file_id,
                              const TakeForeignPoint& take) {
  const ForeignTable& t = *table;
  if (t.names().empty()) {
    if (t.column_count() < 6) FailUnknown(t);
    ReadBoxes(table, {0, 1, 2, 3, 4, 5, t.column_count() > 6 ? Column(6) : std::nullopt}, take);
    return "MOTChallenge";
  }
  const Column frame = FirstOf(t, {"frame", "frameid", "framenumber"});
  const BoxColumns boxes{frame,
                         FirstOf(t, {"id", "trackid", "track_id"}),
                         FirstOf(t, {"left", "bb_left", "bbleft"}),
                         FirstOf(t, {"top", "bb_top", "bbtop"}),
                         FirstOf(t, {"width", "bb_width", "w"}),
                         FirstOf(t, {"height", "bb_height", "h"}),
                         FirstOf(t, {"confidence", "conf", "score"})};
  if (frame && boxes.left && boxes.top && boxes.width && boxes.height) {
    ReadBoxes(table, boxes, take);
    return "MOTChallenge";
  }
  const std::string camera = "_cam" + std::to_string(options.camera);
  WideColumns digitised = FindWide(t, "pt", "pt", camera + "_x", camera + "_y");
  if (!digitised.animals.empty()) {
    digitised.first_pixel = 1;
    ReadWide(table, digitised, take);
    return "DLTdv";
  }
  if (t.Find("pt1_cam1_x")) {
    t.Fail(1, "the file has no camera " + std::to_string(options.camera), NamesFound(t));
  }
  const Column time = FirstOf(t, {"time", "seconds"}), x = t.Find("x"), y = t.Find("y");
  WideColumns wide = FindWide(t, "x", "y", "", "");
  if (time && !wide.animals.empty()) {
    wide.time = time;
    ReadWide(table, wide, take);
    return "idtracker.ai";
  }
  if (frame && x && y && t.Find("individual")) {
    PointColumns tidy{.frame = frame, .id = t.Find("individual"), .x = x, .y = y, .time = time};
    tidy.probability = t.Find("probability");
    ReadPoints(table, tidy, kNoId, take);
    return "idtracker.ai";
  }
  const Column particle = t.Find("particle");
  if (frame && x && y && (particle || FirstOf(t, {"mass", "signal", "ecc", "raw_mass", "size"}))) {
    ReadPoints(table, {.frame = frame, .id = particle, .x = x, .y = y, .radius = t.Find("size")},
               kNoId, take);
    return "trackpy";
  }
  const Column trex_x = FirstOf(t, {"x#wcentroid", "x"}), trex_y = FirstOf(t, {"y#wcentroid", "y"});
  if (frame && trex_x && trex_y && !t.Find("id")) {
    ReadPoints(table,
               {.frame = frame,
                .id = {},
                .x = trex_x,
                .y = trex_y,
                .missing = t.Find("missing"),
                .area = t.Find("num_pixels"),
                .time = time},
               file_id, take);
    return "TRex";
  }
  FailUnknown(t);
}

}  // namespace flocklift::internal
