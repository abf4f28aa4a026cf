// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Blobs in, tracks out, frame by frame: keeps the first frames until the motion noise is learned,
// learns it anew as the footage goes on, and at the end mends, stitches and finishes the tracks.

#ifndef FLOCKLIFT_TRACK_LINKER_H_
#define FLOCKLIFT_TRACK_LINKER_H_

#include <optional>
#include <string_view>
#include <vector>

#include "track/associate/flock_tracker.h"
#include "track/camera_path.h"
#include "track/static_clutter.h"
#include "track/tracker.h"

namespace flocklift::internal {

class Linker {
 public:
  // `options` must outlive the linker. Width and height are the picture's [px].
  Linker(const TrackerOptions& options, double width, double height)
      : options_(options), width_(width), height_(height) {}

  void Add(BlobFrame frame);

  // Whether the first frames have shown that the animals cannot be told apart: nothing is linked.
  bool has_declined() const { return !separability_.is_enough; }

  // Whether there is a state to save: not while the first frames are kept.
  bool CanSave() const { return tracker_.has_value(); }
  // As FlockTracker's.
  void Save(StateWriter* state, StateWriter* log);
  void Load(StateReader* state, std::string_view log);

  // Call once, at the end. `report` holds what is known of the detection; its counts go on.
  TrackerResult Finish(std::optional<double> fps, TrackerReport report);

 private:
  void Start();
  void Step(const BlobFrame& frame);

  const TrackerOptions& options_;
  double width_, height_;
  // How the animals move, with constant velocity, for joins and for the final smoothing; and by the
  // likelier model of the bank, which predicts them from frame to frame.
  MotionNoise noise_, model_;
  StaticClutter clutter_;
  Separability separability_;
  CameraPath camera_;
  std::vector<BlobFrame> first_;
  std::optional<FlockTracker> tracker_;
  int steps_ = 0;
};

// What is left to do when all sightings are there: mend, stitch, finish.
TrackerResult JoinAndFinish(const TrackerOptions& options, const MotionNoise& noise,
                            std::optional<double> fps, double width, double height,
                            const CameraPath& camera, std::vector<TrackRecord> records,
                            TrackerReport report);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_LINKER_H_
