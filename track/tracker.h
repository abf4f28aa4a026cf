// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From footage to 2D tracks: detect by local contrast, predict by Kalman filters whose noise is
// learned from the footage, share blobs that hold several animals, assign globally, stitch tracks
// over gaps, smooth, fill the gaps. Image positions in pixels (simulate/core/observations.h).

#ifndef FLOCKLIFT_TRACK_TRACKER_H_
#define FLOCKLIFT_TRACK_TRACKER_H_

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/options.h"
#include "simulate/core/progress.h"
#include "track/associate/flock_tracker.h"
#include "track/associate/stitch.h"
#include "track/detect/camera_motion.h"
#include "track/detect/detector.h"
#include "track/separability.h"
#include "track/suspicion.h"

namespace flocklift {

struct TrackerOptions {
  DetectorOptions detect = {};
  AssociationOptions associate = {};
  StitchOptions stitch = {};
  CameraMotionOptions camera = {};
  int min_length = 5;       // a track with fewer sightings is dropped
  double min_travel = 0.7;  // a long track that stays within so many of its sizes stands still
  bool decline = true;      // give no identities to animals that cannot be told apart
};

template <typename Visitor>
void Describe(Visitor& visit, TrackerOptions& o) {
  Describe(visit, o.detect);
  Describe(visit, o.associate);
  Describe(visit, o.stitch);
  Describe(visit, o.camera);
  visit("decline", o.decline, {}, "",
        "give no identities where the animals cannot be told apart: density and flow instead");
  visit("min-length", o.min_length, {.low = 1, .high = 100000}, "frames",
        "tracks with fewer sightings are dropped");
  visit("min-travel", o.min_travel, {.low = 0, .high = 1000}, "sizes",
        "what stands still from the start, or is seen for a second or longer and moves less, is no "
        "animal; 0 keeps all");
}

// Wall time of each part; parts overlap, so they need not add up.
struct TrackerTimings {
  double decode_s = 0, detect_s = 0, camera_s = 0, associate_s = 0, finish_s = 0, total_s = 0;
};

struct TrackerReport {
  std::optional<double> fps;  // given, or the footage's [1/s]
  std::int64_t frames = 0;
  std::int64_t frames_before = 0;  // of these, of a run before that was killed
  std::int64_t detections = 0;     // blobs
  std::int64_t tracks = 0;
  std::int64_t rows = 0;          // of all tracks
  std::int64_t shared_rows = 0;   // of these, from blobs that held several animals
  std::int64_t filled_rows = 0;   // of these, interpolated
  std::int64_t joins = 0;         // tracks stitched to one before
  std::int64_t exchanges = 0;     // of tracks after a shared blob
  std::int64_t still_tracks = 0;  // dropped: they did not move
  std::int64_t clutter = 0;       // places where something stood from the start (static_clutter.h)
  Separability separability;      // of the first seconds; not enough: there are no tracks
  bool camera_moves = false;      // and was followed
  std::vector<Suspicion> suspicions;  // the likeliest mistake first
  MotionNoise noise;                  // as learned, with constant velocity
  double correlation = 0;             // of Singer's model where that predicts better [frames]
  double usual_length_px = 0;         // 4 sd of an animal's major axis
  double usual_contrast = 0;          // [grey levels]
  bool dark = true, bright = false;   // the sign of the animals' contrast
  TrackerTimings timings;
  std::vector<std::string> warnings;
};

struct TrackerResult {
  Tracks tracks;  // ids 1, 2, ... by first frame; measured rows have shapes
  TrackerReport report;
};

// Where a run keeps what memory does not hold, and what it goes on from when it is killed; not an
// option, as it decides no byte.
struct CheckpointPlace {
  std::filesystem::path folder = {};  // empty: nothing is kept, all tracks are in memory
  std::chrono::seconds every{20};     // of wall time
};

// What becomes of a finished track.
using TakeTracklet = std::function<void(Tracklet)>;

// Tracks what a video shows, and gives each track, ids 1, 2, ... by first frame, to `take`. `fps`
// overrides the video's. Memory: a few dozen frames, the newest sightings of the animals in view,
// some numbers a track, and at the end one track at a time; the rest is in the checkpoint's folder,
// about 130 bytes a row. A run that was killed goes on from its checkpoint and ends with the same
// bytes; the folder is removed at the end. Throws InputError when there is nothing to read
// (video_source.h).
TrackerReport StreamTracks(const TrackerOptions& options, const std::filesystem::path& path,
                           const TakeTracklet& take, const Progress& progress = {},
                           std::optional<double> fps = {}, const CheckpointPlace& checkpoint = {});

// The same, with all tracks in memory.
TrackerResult TrackVideo(const TrackerOptions& options, const std::filesystem::path& path,
                         const Progress& progress = {}, std::optional<double> fps = {},
                         const CheckpointPlace& checkpoint = {});

// Links detections that somebody else made, of a picture of the given size. `frames` by increasing
// frame.
TrackerResult TrackDetections(const TrackerOptions& options, std::span<const DetectionFrame> frames,
                              double image_width, double image_height,
                              std::optional<double> fps = {});

// Goes on from tracks that somebody else made: joins them over gaps and fills the gaps. The rows
// that were given stay as they are, and so do the ids (of joined tracks the first one's).
TrackerResult ContinueTracks(const TrackerOptions& options, const Tracks& tracks,
                             double image_width, double image_height);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_TRACKER_H_
