// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The curl noise that velocities y were seen of, where it was not seen: with scale, gain and the
// rest's sd s known, the lattice's gradients g have the mean
//   E[gain g | y] = r P A' Sigma^-1 y,   r = gain^2 / s^2       (noise_evidence.h)
// and V = A(x) E[gain g | y] anywhere; lattice points that nobody felt count 0.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_EXPECTED_FIELD_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_EXPECTED_FIELD_H_

#include <array>
#include <span>
#include <vector>

#include "reconstruct/fit/noise_evidence.h"

namespace flocklift {

class ExpectedField {
 public:
  ExpectedField(const VelocitySample& seen, double scale, double r);

  std::vector<Vec3d> At(std::span<const Vec3d> positions) const;  // [m/s]

 private:
  double scale_;
  std::vector<LatticePoint> lattice_;             // in increasing order
  std::vector<std::array<double, 9>> gradients_;  // times the gain
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_EXPECTED_FIELD_H_
