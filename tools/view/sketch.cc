// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/sketch.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr std::size_t kMostStrokes = 1000, kMostPoints = 5000;
constexpr int kMostFrames = 100'000;
constexpr double kFarthest = 1e6;  // [px]

}  // namespace

std::vector<Vec3d> EvenlyAlong(std::span<const Vec3d> line, int count) {
  Check(line.size() >= 2 && count >= 2, "a line needs two points");
  std::vector<double> length_to = {0};
  for (std::size_t k = 1; k < line.size(); ++k) {
    length_to.push_back(length_to.back() + Norm(line[k] - line[k - 1]));
  }
  std::vector<Vec3d> points;
  std::size_t k = 1;
  for (int j = 0; j < count; ++j) {
    const double at = length_to.back() * j / (count - 1);
    while (k + 1 < line.size() && length_to[k] < at) ++k;
    const double piece = length_to[k] - length_to[k - 1];
    const double w = piece > 0 ? std::clamp((at - length_to[k - 1]) / piece, 0.0, 1.0) : 0;
    points.push_back(line[k - 1] + w * (line[k] - line[k - 1]));
  }
  return points;
}

std::vector<Stroke> StrokesOf(const nlohmann::ordered_json& json) {
  std::vector<Stroke> strokes;
  for (const auto& one : json.at("strokes")) {
    Stroke stroke{
        .first = one.at("first").get<int>(), .last = one.at("last").get<int>(), .points = {}};
    Check(stroke.first >= 1 && stroke.last > stroke.first && stroke.last <= kMostFrames,
          "a stroke needs at least two frames");
    for (const auto& point : one.at("points")) {
      const Vec2d p{point.at(0).get<double>(), point.at(1).get<double>()};
      Check(std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest, "a point is far outside");
      stroke.points.push_back(p);
    }
    Check(stroke.points.size() >= 2 && stroke.points.size() <= kMostPoints,
          "a stroke needs two points, and not thousands");
    strokes.push_back(std::move(stroke));
  }
  Check(!strokes.empty() && strokes.size() <= kMostStrokes, "draw a stroke first");
  return strokes;
}

Tracks TracksOfStrokes(std::span<const Stroke> strokes, double size) {
  Tracks tracks;
  for (const Stroke& stroke : strokes) {
    std::vector<Vec3d> line;
    for (const Vec2d& p : stroke.points) line.push_back({p.x, p.y, 0});
    Tracklet& tracklet = tracks.tracklets.emplace_back();
    tracklet.id = static_cast<Id>(tracks.tracklets.size());
    int frame = stroke.first;
    for (const Vec3d& p : EvenlyAlong(line, stroke.last - stroke.first + 1)) {
      Detection detection;
      detection.frame = frame++;
      detection.box = Box::Around({p.x, p.y}, size, size);
      tracklet.detections.push_back(detection);
    }
  }
  return tracks;
}

}  // namespace flocklift
