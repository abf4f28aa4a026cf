// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Blobs in, tracks out, frame by frame: keeps the first frames until the motion noise is learned,
// learns it anew as the footage goes on, and at the end mends, stitches and finishes the tracks.

#ifndef FLOCKLIFT_TRACK_LINKER_H_
#define FLOCKLIFT_TRACK_LINKER_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "track/associate/flock_tracker.h"
#include "track/camera_path.h"
#include "track/static_clutter.h"
#include "track/tracker.h"

namespace flocklift::internal {

class Linker {
 public:
  // `options` must outlive the linker, and so must `file`, if any (flock_tracker.h). Width and
  // height are the picture's [px].
  Linker(const TrackerOptions& options, double width, double height, SightingFile* file = nullptr)
      : options_(options), width_(width), height_(height), file_(file) {}

  void Add(BlobFrame frame);

  // Whether the first frames have shown that the animals cannot be told apart: nothing is linked.
  bool has_declined() const { return !separability_.is_enough; }

  // Whether, when the first frames are there, something that stands still may be a reason to ask
  // for all frames anew, without it. Then nothing was linked.
  void set_may_ask(bool may_ask) { may_ask_ = may_ask; }
  bool asks_for_second_look() const { return asks_; }
  std::int64_t clutter() const { return static_cast<std::int64_t>(clutter_.learned()); }  // places

  // Whether there is a state to save: not while the first frames are kept.
  bool CanSave() const { return tracker_.has_value(); }
  // As FlockTracker's.
  void Save(StateWriter* state) const;
  void Load(StateReader* state);

  // Call once, at the end. `report` holds what is known of the detection; its counts go on.
  void Finish(const TakeTracklet& take, TrackerReport* report);

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
  SightingFile* file_;
  bool may_ask_ = false, asks_ = false;
};

// What is left to do when all sightings are there: mend, stitch, finish.
void JoinAndFinish(const TrackerOptions& options, const MotionNoise& noise, double width,
                   double height, const CameraPath& camera, std::vector<TrackRecord> records,
                   const TakeTracklet& take, TrackerReport* report);

// The result of what finishes tracks one by one: all of them together.
TrackerResult Gather(TrackerReport report,
                     const std::function<void(const TakeTracklet&, TrackerReport*)>& finish);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_LINKER_H_
