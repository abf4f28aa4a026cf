// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/finish.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "track/predict/smoother.h"

namespace flocklift::internal {
namespace {

constexpr double kMostSharedConfidence = 0.9;
constexpr double kMostFilledConfidence = 0.49;
constexpr std::size_t kLeastWhole = 5;  // sightings that tell an animal's usual size

bool StandsStill(std::span<const TrackPoint> sightings, double size, double min_travel) {
  double left = 1e18, right = -1e18, top = 1e18, bottom = -1e18;
  for (const TrackPoint& s : sightings) {
    left = std::min(left, s.position.x);
    right = std::max(right, s.position.x);
    top = std::min(top, s.position.y);
    bottom = std::max(bottom, s.position.y);
  }
  return std::hypot(right - left, bottom - top) < min_travel * size;
}

Shape ShapeInImage(Shape shape, const Similarity& world_from_image) {
  if (world_from_image.IsIdentity()) return shape;
  const double zoom = std::hypot(world_from_image.a, world_from_image.b);
  shape.major /= zoom;
  shape.minor /= zoom;
  shape.angle_deg = std::fmod(shape.angle_deg - world_from_image.angle_deg() + 360, 180);
  return shape;
}

double SharedConfidence(double variance, double own_variance) {
  const double ambiguity = std::clamp(1 - own_variance / variance, 0.0, 1.0);
  return kMostSharedConfidence - (kMostSharedConfidence - kMeasuredConfidence) * ambiguity;
}

// `variance` of the place, per axis.
double FilledConfidence(double variance, double size) {
  return kMostFilledConfidence / (1 + 4 * variance / (size * size));
}

double Median(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// Where the picture's edge cuts an animal off, its centre is reckoned from the side that is seen
// and its usual size; sightings whose centre is outside the picture are left out.
void CompleteAtEdges(const CameraPath& camera, double image_width, double image_height,
                     std::vector<TrackPoint>* sightings) {
  std::vector<double> widths, heights;
  for (const TrackPoint& s : *sightings) {
    if (s.edges.any() || s.shared) continue;
    widths.push_back(s.box.width);
    heights.push_back(s.box.height);
  }
  if (widths.size() < kLeastWhole) return;
  const double width = Median(&widths), height = Median(&heights);
  std::size_t kept = 0;
  for (TrackPoint s : *sightings) {
    const Box& b = s.box;
    s.position = camera.ToImage(s.frame, s.position);
    if (s.edges.left) s.position.x = std::min(s.position.x, b.left + b.width - 0.5 * width);
    if (s.edges.right) s.position.x = std::max(s.position.x, b.left + 0.5 * width);
    if (s.edges.top) s.position.y = std::min(s.position.y, b.top + b.height - 0.5 * height);
    if (s.edges.bottom) s.position.y = std::max(s.position.y, b.top + 0.5 * height);
    if (s.position.x < 0 || s.position.y < 0 || s.position.x > image_width - 1 ||
        s.position.y > image_height - 1) {
      continue;
    }
    s.position = camera.ToWorld(s.frame, s.position);
    (*sightings)[kept++] = s;
  }
  sightings->resize(kept);
}

Footage FootageOf(const std::vector<TrackRecord>& records, double width, double height) {
  Footage footage{.width = width, .height = height};
  if (records.empty()) return footage;
  footage.first_frame = records[0].sightings.first_frame();
  for (const TrackRecord& record : records) {
    footage.first_frame = std::min(footage.first_frame, record.sightings.first_frame());
    footage.last_frame = std::max(footage.last_frame, record.sightings.last_frame());
  }
  return footage;
}

// The rows of one animal, whose own those of the report's counts are. `sightings` has some.
std::vector<Detection> RowsOf(const std::vector<TrackPoint>& sightings, const TrackRecord& record,
                              const MotionNoise& noise, const CameraPath& camera,
                              double image_width, double image_height, TrackerReport* report) {
  std::vector<Measurement> measurements;
  measurements.reserve(sightings.size());
  for (const TrackPoint& s : sightings) {
    measurements.push_back({s.frame, s.position, s.variance, s.agility});
  }
  const std::vector<MotionState> states =
      Smooth(measurements, noise.ProcessVariance(record.size), noise.speed_sd);
  std::vector<Detection> rows;
  rows.reserve(states.size());
  std::size_t next = 0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const int frame = measurements.front().frame + static_cast<int>(k);
    Detection row;
    row.frame = frame;
    const Vec2d p = camera.ToImage(frame, states[k].position);
    if (sightings[next].frame == frame) {
      const TrackPoint& s = sightings[next++];
      if (record.given_id != kNoId) {
        row.box = s.box;
        row.confidence = s.given_confidence;
        rows.push_back(row);
        continue;
      }
      row.box = Box::Around(p, s.box.width, s.box.height);
      row.confidence =
          s.shared ? SharedConfidence(s.variance, noise.MeasurementVariance(record.size)) : 1.0;
      if (!s.shared) row.shape = ShapeInImage(s.shape, camera.WorldFromImage(frame));
      report->shared_rows += s.shared ? 1 : 0;
    } else {
      if (p.x < 0 || p.y < 0 || p.x > image_width - 1 || p.y > image_height - 1) continue;
      const TrackPoint& before = sightings[next - 1];
      const TrackPoint& after = sightings[next];
      const double w = static_cast<double>(frame - before.frame) / (after.frame - before.frame);
      row.box = Box::Around(p, before.box.width + w * (after.box.width - before.box.width),
                            before.box.height + w * (after.box.height - before.box.height));
      row.confidence = FilledConfidence(states[k].pp, record.size);
      ++report->filled_rows;
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

void FinishTracks(const TrackerOptions& options, const MotionNoise& noise, double image_width,
                  double image_height, const CameraPath& camera, std::vector<TrackRecord> records,
                  const TakeTracklet& take, TrackerReport* report) {
  const double long_frames = report->fps.value_or(30);
  const Footage footage = FootageOf(records, image_width, image_height);
  std::vector<Id> ids(records.size(), kNoId);
  for (std::size_t r = 0; r < records.size(); ++r) {
    TrackRecord& record = records[r];
    const bool is_given = record.given_id != kNoId;
    if (!is_given && static_cast<int>(record.sightings.size()) < options.min_length) continue;
    std::vector<TrackPoint> sightings = record.sightings.All();
    record.sightings = {};  // long footage: no row stands here twice
    if (!is_given && static_cast<double>(sightings.size()) >= long_frames &&
        StandsStill(sightings, record.size, options.min_travel)) {
      ++report->still_tracks;
      continue;
    }
    const std::vector<Doubt> doubts = DoubtsOf(noise, footage, camera, record.size, sightings);
    if (!is_given) CompleteAtEdges(camera, image_width, image_height, &sightings);
    if (!is_given && static_cast<int>(sightings.size()) < options.min_length) continue;
    record.doubts.insert(record.doubts.end(), doubts.begin(), doubts.end());
    for (Doubt& d : record.doubts) d.position = camera.ToImage(d.first_frame, d.position);
    ++report->tracks;
    ids[r] = is_given ? record.given_id : report->tracks;
    Tracklet tracklet{ids[r],
                      RowsOf(sightings, record, noise, camera, image_width, image_height, report)};
    report->rows += static_cast<std::int64_t>(tracklet.detections.size());
    take(std::move(tracklet));
  }
  report->suspicions = RankSuspicions(records, ids);
}

}  // namespace flocklift::internal
