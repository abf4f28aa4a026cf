// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The frames of a film one by one, behind whatever hides animals there, and tracks of what is seen
// in them.

#ifndef FLOCKLIFT_SIMULATE_OBSERVE_FRAMES_H_
#define FLOCKLIFT_SIMULATE_OBSERVE_FRAMES_H_

#include <functional>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/observations.h"
#include "simulate/core/rigid3.h"
#include "simulate/core/trajectory.h"
#include "simulate/render/depth_buffer.h"
#include "simulate/render/scenery.h"

namespace flocklift {

struct SeenAnimal {
  Id id;
  Detection detection;  // the frame is filled in
};

// Adds who is seen in a frame. `surfaces`: null where nothing hides anybody. Called from several
// threads at once.
using ObserveFrame =
    std::function<void(int frame, const Rigid3d& cam_from_world, const DepthBuffer* surfaces,
                       std::vector<SeenAnimal>* seen)>;

// Tracks by increasing id. `scenery` may be null; `threads` (0: all) does not change the result.
Tracks ObserveFrames(const FrameSpan& span, double fps, const Camera& camera,
                     const Scenery* scenery, int threads, const ObserveFrame& observe);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_OBSERVE_FRAMES_H_
