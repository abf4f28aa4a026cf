// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/finish.h"

#include <algorithm>
#include <cmath>

#include "track/predict/smoother.h"

namespace flocklift::internal {
namespace {

constexpr double kSharedConfidence = 0.7;
constexpr double kFilledConfidence = 0.4;

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

}  // namespace

Tracks FinishTracks(const TrackerOptions& options, const MotionNoise& noise,
                    std::optional<double> frames_per_second, double image_width,
                    double image_height, const std::vector<TrackRecord>& records,
                    TrackerReport* report) {
  Tracks tracks;
  tracks.fps = frames_per_second;
  const double long_frames = frames_per_second.value_or(30);
  for (const TrackRecord& record : records) {
    if (static_cast<int>(record.sightings.size()) < options.min_length) continue;
    if (static_cast<double>(record.sightings.size()) >= long_frames &&
        StandsStill(record, options.min_travel)) {
      ++report->still_tracks;
      continue;
    }
    std::vector<Measurement> measurements;
    for (const TrackPoint& s : record.sightings) {
      measurements.push_back({s.frame, s.position, s.variance, s.agility});
    }
    const std::vector<MotionState> states =
        Smooth(measurements, noise.ProcessVariance(record.size), noise.speed_sd);
    Tracklet tracklet;
    tracklet.id = static_cast<Id>(tracks.tracklets.size()) + 1;
    std::size_t next = 0;
    for (std::size_t k = 0; k < states.size(); ++k) {
      const int frame = measurements.front().frame + static_cast<int>(k);
      Detection row;
      row.frame = frame;
      const Vec2d& p = states[k].position;
      if (record.sightings[next].frame == frame) {
        const TrackPoint& s = record.sightings[next++];
        row.box = Box::Around(p, s.width, s.height);
        row.confidence = s.shared ? kSharedConfidence : 1.0;
        if (!s.shared) row.shape = s.shape;
        report->shared_rows += s.shared ? 1 : 0;
      } else {
        if (p.x < 0 || p.y < 0 || p.x > image_width - 1 || p.y > image_height - 1) continue;
        const TrackPoint& before = record.sightings[next - 1];
        const TrackPoint& after = record.sightings[next];
        const double w = static_cast<double>(frame - before.frame) / (after.frame - before.frame);
        row.box = Box::Around(p, before.width + w * (after.width - before.width),
                              before.height + w * (after.height - before.height));
        row.confidence = kFilledConfidence;
        ++report->filled_rows;
      }
      tracklet.detections.push_back(row);
    }
    report->rows += static_cast<std::int64_t>(tracklet.detections.size());
    tracks.tracklets.push_back(std::move(tracklet));
  }
  return tracks;
}

}  // namespace flocklift::internal
