// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/interchange/foreign_tracks.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "simulate/core/check.h"
#include "simulate/core/input_file.h"
#include "simulate/core/table.h"
#include "track/interchange/foreign_layouts.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

using internal::ForeignPoint;
using internal::ForeignTable;

constexpr double kMostId = 9e15;  // whole numbers beyond are not exact

// Gathers the points of one or several files.
class Gatherer {
 public:
  explicit Gatherer(const ForeignOptions& options) : options_(options) { CheckOptions(options); }

  void Read(std::istream& stream, const std::string& name, Id file_id) {
    ForeignTable table(stream, name);
    const std::string layout = internal::ReadForeignPoints(
        &table, options_, file_id,
        [&](const ForeignPoint& point, long line) { Add(point, table, line); });
    if (!layout_.empty() && layout != layout_) {
      table.Fail(0, "the layout is " + layout + ", that of the files before " + layout_,
                 "put files of one program into the folder");
    }
    layout_ = layout;
  }

  ForeignTracks Result(const std::string& name) const {
    if (by_id_.empty()) {
      throw InputError(name, 0, "no animal is in any row", "give detections or tracks");
    }
    ForeignTracks result;
    result.layout = layout_;
    result.has_boxes = boxes_known_;
    result.has_ids = by_id_.size() > 1 || by_id_.begin()->first != kNoId;
    if (result.has_ids && by_id_.contains(kNoId)) {
      throw InputError(name, 0, "some rows have an id and others none",
                       "give all of them one, or none");
    }
    result.tracks.fps = Rate();
    if (!result.has_ids) {
      for (const Detection& d : by_id_.at(kNoId)) {
        if (result.detections.empty() || result.detections.back().frame != d.frame) {
          result.detections.push_back({d.frame, {}});
        }
        result.detections.back().detections.push_back(d);
      }
      return result;
    }
    for (const auto& [id, rows] : by_id_) result.tracks.tracklets.push_back({id, rows});
    return result;
  }

  // By frame within an animal; refuses a frame that stands twice.
  void Sort(const std::string& name) {
    for (auto& [id, rows] : by_id_) {
      std::stable_sort(rows.begin(), rows.end(),
                       [](const Detection& a, const Detection& b) { return a.frame < b.frame; });
      if (id == kNoId) continue;
      const auto twice = std::adjacent_find(
          rows.begin(), rows.end(),
          [](const Detection& a, const Detection& b) { return a.frame == b.frame; });
      if (twice == rows.end()) continue;
      throw InputError(
          name, 0,
          "animal " + std::to_string(id) + " stands twice in frame " + std::to_string(twice->frame),
          "take one of the rows out");
    }
  }

 private:
  void Add(const ForeignPoint& point, const ForeignTable& table, long line) {
    if (!(point.frame >= 1 && point.frame <= internal::kMaxFrame) ||
        point.frame != std::floor(point.frame)) {
      table.Fail(line, "the frame is no whole number from 1 on, or from 0 where the layout says so",
                 "count the frames");
    }
    const bool has_id = point.id != kNoId;
    if (has_id && (!(point.id >= 1 && point.id <= kMostId) || point.id != std::floor(point.id))) {
      table.Fail(line, "the id is no positive whole number", "number the animals");
    }
    const double s = options_.scale;
    double x = s * point.x, y = s * point.y;
    if (options_.up_height > 0) y = options_.up_height - 1 - y;
    const bool has_box = point.width > 0;
    const double width = has_box ? s * point.width : options_.box;
    const double height = has_box ? s * point.height : options_.box;
    for (const double value : {x, y, width, height}) {
      if (std::abs(value) <= internal::kMaxMagnitude) continue;
      table.Fail(line, "a position or size is beyond any picture", "give pixels");
    }
    boxes_known_ = boxes_known_ && has_box;
    if (point.time) AddTime(point.frame, *point.time);
    Detection d;
    d.frame = static_cast<int>(point.frame);
    d.box = Box::Around({x, y}, width, height);
    // Programs score in ranges of their own; only a probability tells what is interpolated.
    d.confidence = point.confidence > 0 && point.confidence <= 1 ? point.confidence : 1;
    by_id_[has_id ? static_cast<Id>(point.id) : kNoId].push_back(d);
  }

  void AddTime(double frame, double time) {
    if (!first_time_ || frame < first_time_->first) first_time_ = {frame, time};
    if (!last_time_ || frame > last_time_->first) last_time_ = {frame, time};
  }

  std::optional<double> Rate() const {
    if (!first_time_ || last_time_->first <= first_time_->first) return std::nullopt;
    const double rate =
        (last_time_->first - first_time_->first) / (last_time_->second - first_time_->second);
    if (!(rate > 0.001 && rate < 1e6)) return std::nullopt;
    return std::round(1000 * rate) / 1000;  // times are rounded, too
  }

  const ForeignOptions& options_;
  std::string layout_;
  bool boxes_known_ = true;
  std::map<Id, std::vector<Detection>> by_id_;
  std::optional<std::pair<double, double>> first_time_, last_time_;  // frame, [s]
};

std::vector<fs::path> TablesOf(const fs::path& folder) {
  // idtracker.ai's session folder.
  for (const char* inside :
       {"trajectories/trajectories_csv/trajectories.csv", "trajectories_csv/trajectories.csv",
        "trajectories.csv", "trajectories/trajectories_tidy.csv", "trajectories_tidy.csv"}) {
    if (fs::is_regular_file(folder / inside)) return {folder / inside};
  }
  std::vector<fs::path> tables;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".csv") {
      tables.push_back(entry.path());
    }
  }
  if (tables.empty()) {
    throw InputError(folder.string(), 0, "the folder holds no .csv file",
                     "give the file, or TRex's folder of one file an animal");
  }
  std::sort(tables.begin(), tables.end(), [](const fs::path& a, const fs::path& b) {
    return NaturalLess(a.filename().string(), b.filename().string());
  });
  return tables;
}

}  // namespace

ForeignTracks ReadForeignTracks(std::istream& stream, const std::string& name,
                                const ForeignOptions& options) {
  Gatherer gatherer(options);
  gatherer.Read(stream, name, 1);
  gatherer.Sort(name);
  return gatherer.Result(name);
}

ForeignTracks ReadForeignTracks(const fs::path& path, const ForeignOptions& options) {
  std::vector<fs::path> tables{path};
  if (fs::is_directory(path)) tables = TablesOf(path);
  Gatherer gatherer(options);
  Id id = 0;
  for (const fs::path& table : tables) {
    std::ifstream stream = OpenInput(table);
    gatherer.Read(stream, table.string(), ++id);
  }
  gatherer.Sort(path.string());
  return gatherer.Result(path.string());
}

}  // namespace flocklift
