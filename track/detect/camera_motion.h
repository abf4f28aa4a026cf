// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the camera moved from frame to frame, from the background: corners beside the animals (Shi,
// Tomasi 1994), followed by optical flow (Lucas, Kanade 1981, pyramidal), and the similarity
// (rotation, zoom, shift) that most of them agree on (RANSAC). A sky with too few corners, or
// corners that do not agree, say nothing: the camera is taken to rest. Clouds that drift over the
// whole picture count as a camera that moves, which shifts all animals alike and changes nothing.

#ifndef FLOCKLIFT_TRACK_DETECT_CAMERA_MOTION_H_
#define FLOCKLIFT_TRACK_DETECT_CAMERA_MOTION_H_

#include <optional>
#include <string>

#include "simulate/core/options.h"
#include "simulate/core/state_archive.h"
#include "track/detect/blob.h"
#include "track/detect/similarity.h"
#include "track/gray_image.h"

namespace flocklift {

struct CameraMotionOptions {
  std::string camera = "auto";  // rests, moves, or auto: found out
};

template <typename Visitor>
void Describe(Visitor& visit, CameraMotionOptions& o) {
  visit("camera-motion", o.camera, {}, "", "the camera rests, moves, or auto: find out on the way");
}

// The motion that takes what `before` shows to where `now` shows it; nothing where the background
// does not say. `found` are the animals of `before`.
std::optional<Similarity> MotionBetween(const GrayImage& before, const BlobFrame& found,
                                        const GrayImage& now);

class CameraMotion {
 public:
  // Throws std::invalid_argument for another word than the three.
  explicit CameraMotion(const CameraMotionOptions& options);

  // From this frame's picture to the first one's. `found` are the frame's animals. With auto, one
  // frame in some is looked at until the camera is seen to move, fewer the longer it rests.
  Similarity Next(const GrayImage& image, const BlobFrame& found);

  bool moves() const { return moves_; }

  // What was seen so far, to go on from later.
  void Save(StateWriter* state) const;
  void Load(StateReader* state);

 private:
  void Probe(bool is_moving);

  bool is_auto_ = true, moves_ = false;
  int until_probe_ = 0, interval_ = 0;  // frames
  int seen_moving_ = 0, quiet_ = 0;     // probes
  Similarity world_from_image_;
  GrayImage before_;
  BlobFrame before_found_;
  bool has_before_ = false;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_CAMERA_MOTION_H_
