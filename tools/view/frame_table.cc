// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/frame_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

static_assert(std::endian::native == std::endian::little, "windows are little-endian");

constexpr std::uint32_t kMagic = 0x574b4c46;  // "FLKW"
constexpr std::uint32_t kTrajectories = 0, kBoxes = 1;

// Counts the rows of each frame and hands out their places: by frame, then animal.
template <typename Items, typename PointsOf>
FrameRows LayOut(const Items& items, FrameSpan span, const AnimalList& animals,
                 const PointsOf& points_of, std::vector<std::vector<std::uint32_t>>* places) {
  FrameRows rows;
  if (span.last < span.first) return rows;
  rows.first_frame = span.first;
  rows.start.assign(static_cast<std::size_t>(span.last - span.first) + 2, 0);
  for (const auto& item : items) {
    for (const auto& point : points_of(item)) {
      ++rows.start[static_cast<std::size_t>(point.frame - span.first) + 1];
    }
  }
  for (std::size_t k = 1; k < rows.start.size(); ++k) rows.start[k] += rows.start[k - 1];
  rows.animal.resize(rows.start.back());
  std::vector<std::uint32_t> next(rows.start.begin(), rows.start.end() - 1);
  std::vector<std::pair<std::uint32_t, std::size_t>> order;  // place in the list, item
  for (const auto& item : items) order.emplace_back(animals.IndexOf(item.id), order.size());
  std::sort(order.begin(), order.end());
  places->resize(order.size());
  for (const auto& [animal, item] : order) {
    std::vector<std::uint32_t>& mine = (*places)[item];
    mine.reserve(points_of(items[item]).size());
    for (const auto& point : points_of(items[item])) {
      const std::uint32_t place = next[static_cast<std::size_t>(point.frame - span.first)]++;
      rows.animal[place] = animal;
      mine.push_back(place);
    }
  }
  return rows;
}

void Store(const Vec3d& v, std::uint32_t place, std::vector<float>* column) {
  float* to = column->data() + 3 * std::size_t{place};
  to[0] = static_cast<float>(v.x);
  to[1] = static_cast<float>(v.y);
  to[2] = static_cast<float>(v.z);
}

std::int16_t Quantized(double value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0, 1.0) * 32767));
}

template <typename T>
void Append(const std::vector<T>& column, std::size_t per_row, std::size_t first, std::size_t end,
            std::string* bytes) {
  if (first == end) return;
  bytes->append(reinterpret_cast<const char*>(column.data() + per_row * first),
                per_row * (end - first) * sizeof(T));
}

struct RowRange {
  std::size_t first = 0, end = 0;
};

RowRange BeginWindow(std::uint32_t kind, const FrameRows& rows, int first, int last,
                     std::string* bytes) {
  first = std::max(first, rows.first_frame);
  last = std::max(std::min(last, rows.last_frame()), first - 1);
  std::vector<std::uint32_t> start = {0};
  RowRange range;
  if (last >= first) {
    const auto k = static_cast<std::size_t>(first - rows.first_frame);
    const auto n = static_cast<std::size_t>(last - first + 1);
    range = {rows.start[k], rows.start[k + n]};
    start.clear();
    for (std::size_t j = k; j <= k + n; ++j) start.push_back(rows.start[j] - rows.start[k]);
  }
  const std::vector<std::uint32_t> header = {kMagic,
                                             kind,
                                             static_cast<std::uint32_t>(first),
                                             static_cast<std::uint32_t>(start.size() - 1),
                                             start.back(),
                                             0,
                                             0,
                                             0};
  Append(header, 1, 0, header.size(), bytes);
  Append(start, 1, 0, start.size(), bytes);
  Append(rows.animal, 1, range.first, range.end, bytes);
  return range;
}

}  // namespace

void AnimalList::Add(Id id) {
  if (places_.emplace(id, static_cast<std::uint32_t>(ids_.size())).second) ids_.push_back(id);
}

void AnimalList::Add(const Tracks& tracks) {
  for (const Tracklet& t : tracks.tracklets) Add(t.id);
}

void AnimalList::Add(const Trajectories& trajectories) {
  for (const Trajectory& t : trajectories.trajectories) Add(t.id);
}

std::uint32_t AnimalList::IndexOf(Id id) const {
  const auto place = places_.find(id);
  Check(place != places_.end(), "the animal is not in the list");
  return place->second;
}

TrajectoryTable TableOf(const Trajectories& trajectories, const AnimalList& animals) {
  TrajectoryTable table;
  std::vector<std::vector<std::uint32_t>> places;
  table.rows = LayOut(
      trajectories.trajectories, SpanOf(trajectories), animals,
      [](const Trajectory& t) -> const auto& { return t.points; }, &places);
  const std::size_t n = table.rows.animal.size();
  table.position.resize(3 * n);
  table.velocity.resize(3 * n);
  table.sd_depth.resize(n);
  table.orientation.resize(4 * n);
  for (std::size_t t = 0; t < places.size(); ++t) {
    const auto& points = trajectories.trajectories[t].points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const TrajectoryPoint& p = points[k];
      const std::uint32_t place = places[t][k];
      Store(p.position, place, &table.position);
      Store(p.velocity, place, &table.velocity);
      table.sd_depth[place] = trajectories.has_sd_depth ? static_cast<float>(p.sd_depth) : 0;
      const Quaternion q = trajectories.has_orientation
                               ? p.world_from_body
                               : QuaternionFromRotation(WorldFromLevelBody(p.velocity));
      std::int16_t* to = table.orientation.data() + 4 * std::size_t{place};
      to[0] = Quantized(q.w);
      to[1] = Quantized(q.x);
      to[2] = Quantized(q.y);
      to[3] = Quantized(q.z);
    }
  }
  return table;
}

BoxTable TableOf(const Tracks& tracks, const AnimalList& animals) {
  BoxTable table;
  std::vector<std::vector<std::uint32_t>> places;
  table.rows = LayOut(
      tracks.tracklets, SpanOf(tracks), animals,
      [](const Tracklet& t) -> const auto& { return t.detections; }, &places);
  const std::size_t n = table.rows.animal.size();
  table.box.resize(4 * n);
  table.confidence.resize(n);
  for (std::size_t t = 0; t < places.size(); ++t) {
    const auto& detections = tracks.tracklets[t].detections;
    for (std::size_t k = 0; k < detections.size(); ++k) {
      const Detection& d = detections[k];
      float* to = table.box.data() + 4 * std::size_t{places[t][k]};
      to[0] = static_cast<float>(d.box.left);
      to[1] = static_cast<float>(d.box.top);
      to[2] = static_cast<float>(d.box.width);
      to[3] = static_cast<float>(d.box.height);
      table.confidence[places[t][k]] = static_cast<float>(d.confidence);
    }
  }
  return table;
}

std::string PackWindow(const TrajectoryTable& table, int first, int last) {
  std::string bytes;
  const RowRange r = BeginWindow(kTrajectories, table.rows, first, last, &bytes);
  Append(table.position, 3, r.first, r.end, &bytes);
  Append(table.velocity, 3, r.first, r.end, &bytes);
  Append(table.sd_depth, 1, r.first, r.end, &bytes);
  Append(table.orientation, 4, r.first, r.end, &bytes);
  return bytes;
}

std::string PackWindow(const BoxTable& table, int first, int last) {
  std::string bytes;
  const RowRange r = BeginWindow(kBoxes, table.rows, first, last, &bytes);
  Append(table.box, 4, r.first, r.end, &bytes);
  Append(table.confidence, 1, r.first, r.end, &bytes);
  return bytes;
}

}  // namespace flocklift
