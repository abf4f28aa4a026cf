// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Scale and gain of the curl noise that animals drift in, its seed unknown: the inverse problem
// that X. Wang, X. Jin, Z. Deng, L. Zhou, "Inherent noise-aware insect swarm simulation" (2014)
// leaves open. Of greatest marginal likelihood (noise_evidence.h), the rest's sd with them:
//   1. correlation of velocities falls to half over kHalfCorrelation cells, whatever the seed: that
//      gives the scale within a factor of two;
//   2. within that, and beyond where the best is at its end, scales so close that no animal's place
//      in the lattice moves by more than a small part of a cell, each with its best gain, on some
//      of the animals;
//   3. the best of them refined on all; animals off by many times the rest's sd, which something
//      else moves, are left out. That saves a fit from a few; where they are 5 % or more, the gain
//      comes out too high, by 15 to 20 % of the aggregation scene's without its goal.
// The sd are those of the likelihood's curvature, with the gain's corrected for gradients that are
// not normal: their length is the same for all, so that the gain is known better than a variance.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_NOISE_FIELD_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_NOISE_FIELD_H_

#include <vector>

#include "reconstruct/fit/noise_evidence.h"

namespace flocklift {

inline constexpr double kHalfCorrelation = 0.367;  // cells
// Mean square speed of curl noise of unit gain and scale, over seeds and space.
inline constexpr double kNoiseMeanSquare = 2.975;

struct NoiseFieldOptions {
  double scale = 0;         // known [m]; 0: sought
  int coarse_points = 128;  // animals of a sample in the search
  int threads = 1;
};

enum class NoiseFieldStatus {
  kOk,
  kTooFew,   // fewer than kLeastPoints animals in all
  kAtEdge,   // the likelihood grows to the end of the scales that were tried
  kNothing,  // the noise explains nothing of the velocities
};

inline constexpr std::size_t kLeastPoints = 20;

struct NoiseFieldFit {
  NoiseFieldStatus status = NoiseFieldStatus::kOk;
  double scale = 0, scale_sd = 0;  // [m]
  double gain = 0, gain_sd = 0;    // [m^2/s]
  double correlation = 0;          // of the two
  double rest_sd = 0;              // s, of each component of what is left over [m/s]
  double explained = 0;            // share of the mean square of the velocities
  std::size_t used = 0, left_out = 0;

  bool IsUsable() const { return status == NoiseFieldStatus::kOk; }
};

// `samples` are of independent fields: one for noise that stands still. The same at any number of
// threads.
NoiseFieldFit FitNoiseField(const NoiseFieldOptions& options, std::vector<VelocitySample> samples);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_NOISE_FIELD_H_
