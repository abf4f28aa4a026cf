// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What stands out from the sky but never moves: lamp heads, leaves, a perched bird. A place is
// clutter when like blobs were within two pixels of it in a third of the footage's first frames
// (leaves that touch make now one blob, now another; places follow the camera's motion), early,
// midway and late, and about the same point each time: what drifts or diffuses does not. From then
// on the blob that is there, and about as heavy, is taken out of each frame, until the place was
// empty for some seconds. A blob that an animal shares with clutter is heavier, or elsewhere, and
// stays. What comes to rest later is no clutter: an animal keeps its track while it rests.

#ifndef FLOCKLIFT_TRACK_STATIC_CLUTTER_H_
#define FLOCKLIFT_TRACK_STATIC_CLUTTER_H_

#include <cstddef>
#include <span>
#include <vector>

#include "simulate/core/state_archive.h"
#include "track/detect/blob.h"

namespace flocklift::internal {

class StaticClutter {
 public:
  // Consecutive frames, in one world (camera_path.h). Too few teach nothing.
  void Learn(std::span<const BlobFrame> frames);

  // Takes the clutter out.
  void Drop(BlobFrame* frame);

  std::size_t learned() const { return learned_; }  // places

  void Save(StateWriter* state) const;
  void Load(StateReader* state);

 private:
  static constexpr int kThirds = 3;
  struct Place {
    Vec2d position;  // mean of its blobs' centres [px]
    double mass = 0;
    int count = 0;             // of its blobs
    int last_frame = 0;        // with one
    Vec2d sums[kThirds] = {};  // of the centres in each third of what is learned from
    int counts[kThirds] = {};

    bool Rests(double least) const;
  };

  // The place of each blob, -1: none. A place has the nearest blob, one alone.
  std::vector<int> PlacesOf(const BlobFrame& frame) const;

  std::vector<Place> places_;
  std::size_t learned_ = 0;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_STATIC_CLUTTER_H_
