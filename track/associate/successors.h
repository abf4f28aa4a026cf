// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which beginnings of tracks may follow which ends: neighbours in a joint space of time, position
// and velocity, (c t, x, y, w vx, w vy), by a k-d tree (FLANN). An end is looked for where its
// motion leads, in the middle of gaps of 1, 2-3, 4-7, ... frames, within the radius that holds all
// of such a gap: nothing within the bounds is missed, whatever the scales c and w.

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_SUCCESSORS_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_SUCCESSORS_H_

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "track/predict/kalman.h"

namespace flocklift {

struct TrackEnd {
  int frame = 0;
  MotionState state;
};

class Successors {
 public:
  // `speed` is the usual one [px/frame]: it makes frames comparable with pixels.
  Successors(std::span<const TrackEnd> beginnings, double speed);
  ~Successors();
  Successors(const Successors&) = delete;
  Successors& operator=(const Successors&) = delete;

  // The indices, increasing, of beginnings at 1 .. max_gap frames after the end, with a position
  // within reach(gap) of where the end's motion leads [px] and a velocity within `speed_reach`
  // [px/frame], and perhaps some more. `reach` grows with the gap.
  std::vector<int> Find(const TrackEnd& end, int max_gap,
                        const std::function<double(int gap)>& reach, double speed_reach) const;

 private:
  class Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_SUCCESSORS_H_
