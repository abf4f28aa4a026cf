// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/finish.h"

#include <algorithm>
#include <cmath>

#include "track/predict/smoother.h"

namespace flocklift::internal {
namespace {

constexpr double kMostSharedConfidence = 0.9;
constexpr double kMostFilledConfidence = 0.49;
constexpr std::size_t kLeastWhole = 5;  // sightings that tell an animal's usual size

bool StandsStill(const TrackRecord& record, double min_travel) {
  double left = 1e18, right = -1e18, top = 1e18, bottom = -1e18;
  for (const TrackPoint& s : record.sightings) {
    left = std::min(left, s.position.x);
    right = std::max(right, s.position.x);
    top = std::min(top, s.position.y);
    bottom = std::max(bottom, s.position.y);
  }
  return std::hypot(right - left, bottom - top) < min_travel * record.size;
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
std::vector<TrackPoint> CompletedAtEdges(const std::vector<TrackPoint>& sightings,
                                         const CameraPath& camera, double image_width,
                                         double image_height) {
  std::vector<double> widths, heights;
  for (const TrackPoint& s : sightings) {
    if (s.edges.any() || s.shared) continue;
    widths.push_back(s.box.width);
    heights.push_back(s.box.height);
  }
  if (widths.size() < kLeastWhole) return sightings;
  const double width = Median(&widths), height = Median(&heights);
  std::vector<TrackPoint> completed;
  for (TrackPoint s : sightings) {
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
    completed.push_back(s);
  }
  return completed;
}

Footage FootageOf(const std::vector<TrackRecord>& records, double width, double height) {
  Footage footage{.width = width, .height = height};
  if (records.empty()) return footage;
  footage.first_frame = records[0].sightings.front().frame;
  for (const TrackRecord& record : records) {
    footage.first_frame = std::min(footage.first_frame, record.sightings.front().frame);
    footage.last_frame = std::max(footage.last_frame, record.sightings.back().frame);
  }
  return footage;
}

}  // namespace

Tracks FinishTracks(const TrackerOptions& options, const MotionNoise& noise,
                    std::optional<double> frames_per_second, double image_width,
                    double image_height, const CameraPath& camera, std::vector<TrackRecord> records,
                    TrackerReport* report) {
  Tracks tracks;
  tracks.fps = frames_per_second;
  const double long_frames = frames_per_second.value_or(30);
  const Footage footage = FootageOf(records, image_width, image_height);
  std::vector<Id> ids(records.size(), kNoId);
  for (std::size_t r = 0; r < records.size(); ++r) {
    TrackRecord& record = records[r];
    const bool is_given = record.given_id != kNoId;
    if (!is_given && static_cast<int>(record.sightings.size()) < options.min_length) continue;
    if (!is_given && static_cast<double>(record.sightings.size()) >= long_frames &&
        StandsStill(record, options.min_travel)) {
      ++report->still_tracks;
      continue;
    }
    const std::vector<TrackPoint> sightings =
        is_given ? record.sightings
                 : CompletedAtEdges(record.sightings, camera, image_width, image_height);
    if (!is_given && static_cast<int>(sightings.size()) < options.min_length) continue;
    std::vector<Measurement> measurements;
    for (const TrackPoint& s : sightings) {
      measurements.push_back({s.frame, s.position, s.variance, s.agility});
    }
    const std::vector<MotionState> states =
        Smooth(measurements, noise.ProcessVariance(record.size), noise.speed_sd);
    Tracklet tracklet;
    tracklet.id = is_given ? record.given_id : static_cast<Id>(tracks.tracklets.size()) + 1;
    ids[r] = tracklet.id;
    DoubtTrack(noise, footage, camera, &record);
    for (Doubt& d : record.doubts) d.position = camera.ToImage(d.first_frame, d.position);
    std::size_t next = 0;
    for (std::size_t k = 0; k < states.size(); ++k) {
      const int frame = measurements.front().frame + static_cast<int>(k);
      Detection row;
      row.frame = frame;
      const Vec2d p = camera.ToImage(frame, states[k].position);
      if (sightings[next].frame == frame) {
        const TrackPoint& s = sightings[next++];
        if (is_given) {
          row.box = s.box;
          row.confidence = s.given_confidence;
          tracklet.detections.push_back(row);
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
      tracklet.detections.push_back(row);
    }
    report->rows += static_cast<std::int64_t>(tracklet.detections.size());
    tracklet.detections.shrink_to_fit();
    std::vector<TrackPoint>().swap(record.sightings);  // long footage: no row stands here twice
    tracks.tracklets.push_back(std::move(tracklet));
  }
  report->suspicions = RankSuspicions(records, ids);
  return tracks;
}

}  // namespace flocklift::internal
