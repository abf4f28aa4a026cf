// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The way to the scale of curl noise (steps 1 and 2 of noise_field.h): a first guess from the
// correlation of velocities, then the likelihood (noise_evidence.h) at many scales about it.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_NOISE_SEARCH_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_NOISE_SEARCH_H_

#include <functional>
#include <vector>

#include "reconstruct/fit/noise_evidence.h"

namespace flocklift {

inline constexpr double kFirstRatio = 1e3;  // r, where its search starts
inline constexpr double kLeastRatio = 1e-3, kGreatestRatio = 1e12;

struct Minimum {
  double at = 0, value = 0;
};

// Of a function with one valley: a bracket by growing steps, then parabolas and golden sections
// until it is as narrow as `tolerance`.
Minimum Minimize(const std::function<double(double)>& f, double start, double step,
                 double tolerance);

// All samples at one scale.
class NoiseLikelihood {
 public:
  NoiseLikelihood(const std::vector<VelocitySample>& samples, double scale);

  NoiseEvidence::Value At(double r) const;  // summed
  // -2 log p at the best s, without its constant.
  double Profile(double r) const;
  // ... and at the best r, which it returns by its logarithm.
  Minimum Best(double log_r, double step, double tolerance) const;
  double Cost(double gain, double s) const;  // -log p in full, without its constant
  double RestSd(double r) const;             // the best s [m/s]
  const std::vector<NoiseEvidence>& parts() const { return parts_; }

 private:
  std::vector<NoiseEvidence> parts_;
  double equations_ = 0;
};

// So many of a sample's animals, from all over its list.
VelocitySample Thinned(const VelocitySample& sample, std::size_t points);

// Of the velocities, over all animals [m^2/s^2].
double MeanSquare(const std::vector<VelocitySample>& samples);

struct ScalePlace {
  double log_scale = 0;
  double log_r = 0;
  double spacing = 0;    // to the next scale that was tried
  bool at_edge = false;  // the likelihood grows to the last scale that was tried
};

// From so many animals of each sample. The same at any number of threads.
ScalePlace SearchScale(const std::vector<VelocitySample>& samples, int points, int threads);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_NOISE_SEARCH_H_
