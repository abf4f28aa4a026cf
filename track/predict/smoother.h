// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rauch-Tung-Striebel smoother for the filter of kalman.h: every frame between the first and the
// last measurement, with what came before and after.

#ifndef FLOCKLIFT_TRACK_PREDICT_SMOOTHER_H_
#define FLOCKLIFT_TRACK_PREDICT_SMOOTHER_H_

#include <span>
#include <vector>

#include "track/predict/kalman.h"

namespace flocklift {

struct Measurement {
  int frame = 0;
  Vec2d position;       // [px]
  double variance = 1;  // per axis [px^2]
  double agility = 1;   // factor on q in the frames from the measurement before to this one
};

// States at the frames measurements.front().frame .. measurements.back().frame, one each, gaps
// included. `measurements` is not empty and by increasing frame. The velocity before the first
// measurement is 0 with sd `speed_sd` [px/frame].
std::vector<MotionState> Smooth(std::span<const Measurement> measurements, double q,
                                double speed_sd);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_PREDICT_SMOOTHER_H_
