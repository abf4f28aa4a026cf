// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/expected_field.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {

ExpectedField::ExpectedField(const VelocitySample& seen, double scale, double r) : scale_(scale) {
  Check(seen.size() > 0 && r > 0, "a field is expected of velocities and a ratio above 0");
  NoiseDesign design = MakeNoiseDesign(seen.position, scale);
  const Eigen::VectorXd part =
      r * (design.matrix.transpose() * NoiseEvidence(seen, scale).Residual(r));
  const std::array<double, 3> variance = GradientVariance();
  lattice_ = std::move(design.lattice);
  gradients_.resize(lattice_.size());
  for (std::size_t m = 0; m < lattice_.size(); ++m) {
    for (std::size_t c = 0; c < 9; ++c) {
      gradients_[m][c] = variance[c % 3] * part[static_cast<Eigen::Index>(9 * m + c)];
    }
  }
}

std::vector<Vec3d> ExpectedField::At(std::span<const Vec3d> positions) const {
  if (positions.empty()) return {};
  const NoiseDesign design = MakeNoiseDesign(positions, scale_);
  Eigen::VectorXd gradients = Eigen::VectorXd::Zero(design.matrix.cols());
  for (std::size_t m = 0; m < design.lattice.size(); ++m) {
    const auto found = std::lower_bound(lattice_.begin(), lattice_.end(), design.lattice[m]);
    if (found == lattice_.end() || *found != design.lattice[m]) continue;
    const auto& known = gradients_[static_cast<std::size_t>(found - lattice_.begin())];
    for (std::size_t c = 0; c < 9; ++c) gradients[static_cast<Eigen::Index>(9 * m + c)] = known[c];
  }
  const Eigen::VectorXd velocity = design.matrix * gradients;
  std::vector<Vec3d> all;
  for (Eigen::Index k = 0; k < velocity.size(); k += 3) {
    all.push_back({velocity[k], velocity[k + 1], velocity[k + 2]});
  }
  return all;
}

}  // namespace flocklift
