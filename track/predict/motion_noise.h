// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the animals of this footage move and how well they are measured, from the footage itself.
// Both scale with apparent size s (square root of the blob's area, [px]), because an animal twice
// as near looks twice as large and moves twice as fast:
//   q = (acceleration s)^2,   r = (measurement s)^2 + floor^2.
// The two factors are those of a bank under which the innovations of unmistakable paths are the
// most likely, sum over frames of -1/2 min(d^2, cap) - ln S; and so is the correlation time of the
// acceleration, where Singer's model (motion_step.h) is likelier than constant velocity.

#ifndef FLOCKLIFT_TRACK_PREDICT_MOTION_NOISE_H_
#define FLOCKLIFT_TRACK_PREDICT_MOTION_NOISE_H_

#include <span>
#include <vector>

#include "track/detect/blob.h"
#include "track/predict/kalman.h"

namespace flocklift {

struct MotionNoise {
  double acceleration = 0.05;  // [sizes/frame^1.5]
  double measurement = 0.05;   // [sizes]
  double floor = 0.1;          // [px]
  double speed_sd = 5;         // sd of a velocity component over the animals [px/frame]
  double correlation = 0;      // of the acceleration; 0: white noise, constant velocity [frames]

  double ProcessVariance(double size) const { return acceleration * size * acceleration * size; }
  double MeasurementVariance(double size) const {
    return measurement * size * measurement * size + floor * floor;
  }
  MotionStep Step(double frames = 1) const { return StepOf(correlation, frames); }
  // Of an animal that was seen once, with variance `r`; `q` is its process variance.
  MotionState Start(const Vec2d& position, double r, double q) const {
    return {.position = position,
            .velocity = {},
            .pp = r,
            .vv = speed_sd * speed_sd,
            .aa = AccelerationVariance(q, correlation)};
  }
};

// The positions of one animal in consecutive frames.
struct Path {
  double size = 1;  // [px]
  std::vector<Vec2d> positions;
};

// Diagonal of the box around some points [px].
double ExtentOf(std::span<const Vec2d> points);

// Paths of blobs that are each other's nearest from frame to frame (after the path's own velocity)
// and twice as near as the next one. `frames` are consecutive; paths shorter than `least` are
// left out, and so is whatever moves less than its own size (lamps, branches).
std::vector<Path> UnmistakablePaths(std::span<const BlobFrame> frames, int least);

// The best with constant velocity; `start` when there is nothing to learn from.
MotionNoise EstimateMotionNoise(std::span<const Path> paths, const MotionNoise& start);

// The best of the whole bank, given the best with constant velocity.
MotionNoise EstimateMotionModel(std::span<const Path> paths, const MotionNoise& straight);

inline double SizeOf(const Blob& blob) {
  return blob.peak > 0 ? std::sqrt(std::max(blob.mass / blob.peak, 1.0)) : 1.0;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_PREDICT_MOTION_NOISE_H_
