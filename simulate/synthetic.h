// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a perfect tracker would see of a simulated flock, and, in separate calls, what a real one
// might: noise, misses and clutter. Bodies and times are those of the film (simulate/render).

#ifndef FLOCKLIFT_SIMULATE_SYNTHETIC_H_
#define FLOCKLIFT_SIMULATE_SYNTHETIC_H_

#include <cstdint>
#include <span>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/animal.h"
#include "simulate/core/observations.h"
#include "simulate/core/options.h"
#include "simulate/core/trajectory.h"
#include "simulate/render/scenery.h"

namespace flocklift {

// True observations. A row exists while the projected position is on the sensor, hidden or not; its
// box is centred there and as wide and high as the silhouette at the frame's time (without motion
// blur), as a tracker writes it; its shape is the silhouette's, its visibility the share that the
// obstacles of `scenery` (may be null) leave to be seen; other animals do not count. Animals below
// kTablePx take these from the tables of render/speck.h, to a hundredth of their size. An animal
// that returns keeps its id. Animals without a body in `animals` get the default one. threads: 0
// takes all; the result does not depend on it.
Tracks SynthesizeTracks(const Trajectories& trajectories, std::span<const Animal> animals,
                        const Camera& camera, double fps, int threads = 1,
                        const Scenery* scenery = nullptr);

struct ObservationNoise {
  double position_sd = 0.5;  // of the box centre, each coordinate [px]
  double size_sd = 0.05;     // of the logarithm of the size: box and shape grow together
  double miss = 0.02;        // chance that a row is missing
  double clutter = 0;        // mean number of false detections in a frame
};

template <typename Visitor>
void Describe(Visitor& visit, ObservationNoise& o) {
  visit("position-sd", o.position_sd, {.low = 0, .high = 1e3}, "px", "noise of box centres");
  visit("size-sd", o.size_sd, {.low = 0, .high = 2}, "", "noise of log sizes");
  visit("miss", o.miss, {.low = 0, .high = 1}, "", "chance that a detection is missing");
  visit("clutter", o.clutter, {.low = 0, .high = 1e5}, "", "mean false detections in a frame");
}

// Noise and misses; ids stay. What befalls a row depends on (seed, id, frame) alone.
Tracks SynthesizeNoise(const ObservationNoise& noise, std::uint64_t seed, const Tracks& tracks);

// The same without ids, with clutter all over the sensor, in random order: a detector's output, one
// entry for each frame from the first to the last. Clutter has sizes as those in `tracks`, and
// confidence below that of what is real, above kMeasuredConfidence.
std::vector<DetectionFrame> SynthesizeDetections(const ObservationNoise& noise, std::uint64_t seed,
                                                 const Camera& camera, const Tracks& tracks);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SYNTHETIC_H_
