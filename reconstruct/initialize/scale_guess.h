// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A first guess of the scale of the scene from what the user knows: how far the flock's middle is,
// how fast it flies, and how wide its animals look. Crude medians; the solvers start from it.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_SCALE_GUESS_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_SCALE_GUESS_H_

#include "reconstruct/initialize/segments.h"
#include "reconstruct/knowledge.h"

namespace flocklift {

struct ScaleGuess {
  double log_depth = 0;  // of the flock's middle [log m]
  double log_speed = 0;  // mean of the flock [log m/s]
  double log_width = 0;  // apparent width in metres of an animal over all views [log m]
  double lateral_spread =
      0;  // sd of the animals' rays around the flock's middle, the wider coordinate
  double image_acceleration = 0;     // robust sd of a ray's acceleration, one coordinate [1/s^2]
  double log_near = 0, log_far = 0;  // bounds for searching [log m]
};

// A second camera fixes the depth where there is one, then the wingspan (with size in use), near
// and far, the speed, the anchors. Animals whose image hardly moves are no evidence of speed.
ScaleGuess GuessScale(const Knowledge& knowledge, const Segments& segments);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_SCALE_GUESS_H_
