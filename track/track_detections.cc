// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulate/core/check.h"
#include "track/linker.h"
#include "track/stopwatch.h"
#include "track/tracker.h"

namespace flocklift {
namespace {

using internal::Linker;
using internal::Stopwatch;
using internal::Timed;

// A detection as a blob: its shape (or box) as an ellipse of even contrast.
void AppendBlob(const Detection& detection, BlobFrame* frame) {
  constexpr int kRings = 4;
  Blob blob;
  blob.center = detection.box.Center();
  blob.box = detection.box;
  const Shape shape =
      detection.shape.value_or(Shape{detection.box.width, detection.box.height, 0,
                                     0.785 * detection.box.width * detection.box.height});
  blob.moments = MomentsOf(shape);
  blob.mass = std::max(shape.area, 1.0);
  blob.peak = 1;
  blob.snr = 1;
  blob.first_pixel = static_cast<std::uint32_t>(frame->pixels.size());
  const double angle = shape.angle_deg * 3.14159265358979 / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  for (int i = -kRings; i <= kRings; ++i) {
    for (int j = -kRings; j <= kRings; ++j) {
      const double a = static_cast<double>(i) / kRings, b = static_cast<double>(j) / kRings;
      if (a * a + b * b > 1) continue;
      const double x = 0.5 * shape.major * a, y = 0.5 * shape.minor * b;
      frame->pixels.push_back({static_cast<float>(blob.center.x + c * x - s * y),
                               static_cast<float>(blob.center.y + s * x + c * y), 1.0f});
    }
  }
  blob.pixel_count = static_cast<std::uint32_t>(frame->pixels.size()) - blob.first_pixel;
  frame->blobs.push_back(blob);
}

double SizeOf(const Detection& d) { return std::sqrt(0.785 * d.box.width * d.box.height); }

// What the tracks do from frame to frame, where they have no gap.
std::vector<Path> PathsOf(const Tracks& tracks) {
  constexpr std::size_t kLeast = 8, kMost = 60;
  std::vector<Path> paths;
  for (const Tracklet& tracklet : tracks.tracklets) {
    const std::vector<Detection>& rows = tracklet.detections;
    for (std::size_t first = 0, end = 1; first < rows.size(); first = end++) {
      while (end < rows.size() && end - first < kMost && rows[end].frame == rows[end - 1].frame + 1)
        ++end;
      if (end - first < kLeast) continue;
      Path path{SizeOf(rows[first]), {}};
      for (std::size_t k = first; k < end; ++k) path.positions.push_back(rows[k].box.Center());
      if (ExtentOf(path.positions) >= path.size) paths.push_back(std::move(path));
    }
  }
  return paths;
}

TrackRecord RecordOf(const Tracklet& tracklet, const MotionNoise& noise) {
  TrackRecord record;
  record.given_id = tracklet.id;
  const Detection& middle = tracklet.detections[tracklet.detections.size() / 2];
  record.size = SizeOf(middle);
  record.mass = record.size * record.size;
  std::vector<TrackPoint> sightings;
  for (const Detection& d : tracklet.detections) {
    sightings.push_back({.frame = d.frame,
                         .position = d.box.Center(),
                         .variance = noise.MeasurementVariance(record.size),
                         .box = d.box,
                         .given_confidence = d.confidence});
  }
  record.sightings.Append(std::move(sightings));
  return record;
}

}  // namespace

TrackerResult ContinueTracks(const TrackerOptions& options, const Tracks& tracks,
                             double image_width, double image_height) {
  CheckOptions(options);
  Check(image_width > 0 && image_height > 0, "the picture has no size");
  const Stopwatch total;
  TrackerReport report;
  report.fps = tracks.fps;
  TrackerResult result =
      internal::Gather(std::move(report), [&](const TakeTracklet& take, TrackerReport* finished) {
        const Stopwatch finish;
        const MotionNoise noise = EstimateMotionNoise(PathsOf(tracks), MotionNoise{});
        std::vector<TrackRecord> records;
        for (const Tracklet& tracklet : tracks.tracklets) {
          if (!tracklet.detections.empty()) records.push_back(RecordOf(tracklet, noise));
        }
        internal::JoinAndFinish(options, noise, image_width, image_height, {}, std::move(records),
                                take, finished);
        finished->timings.finish_s = finish.Seconds();
      });
  result.report.timings.total_s = total.Seconds();
  return result;
}

TrackerResult TrackDetections(const TrackerOptions& options, std::span<const DetectionFrame> frames,
                              double image_width, double image_height, std::optional<double> fps) {
  CheckOptions(options);
  Check(image_width > 0 && image_height > 0, "the picture has no size");
  const Stopwatch total;
  TrackerReport report;
  Linker linker(options, image_width, image_height);
  int last = 0;
  for (const DetectionFrame& frame : frames) {
    Check(report.frames == 0 || frame.frame > last, "the frames are not by increasing number");
    last = frame.frame;
    BlobFrame blobs;
    blobs.frame = frame.frame;
    for (const Detection& detection : frame.detections) AppendBlob(detection, &blobs);
    ++report.frames;
    report.detections += static_cast<std::int64_t>(blobs.blobs.size());
    Timed(&report.timings.associate_s, [&] { linker.Add(std::move(blobs)); });
  }
  report.fps = fps;
  TrackerResult result = internal::Gather(
      std::move(report),
      [&](const TakeTracklet& take, TrackerReport* finished) { linker.Finish(take, finished); });
  result.report.timings.total_s = total.Seconds();
  return result;
}

}  // namespace flocklift
