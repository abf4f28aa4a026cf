// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The marginal likelihood of velocities y (3 N) that curl noise of unknown seed and an independent
// rest of sd s explain, the lattice's gradients integrated out as if they were normal:
//   y = gain A P^(1/2) h + s e,   h, e ~ N(0, I),   Sigma = I + r A P A',   r = gain^2 / s^2
//   -2 log p(y | scale, r, s) = 3 N log s^2 + log |Sigma| + y' Sigma^-1 y / s^2
// with A of noise_design.h and P its gradients' variances. By a Cholesky factor of Sigma, or of
// I / r + P^(1/2) A' A P^(1/2), whichever is smaller.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_NOISE_EVIDENCE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_NOISE_EVIDENCE_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "reconstruct/fit/noise_design.h"

namespace flocklift {

// Animals in one field: where they are [m] and how fast they drift there [m/s].
struct VelocitySample {
  std::vector<Vec3d> position, velocity;

  std::size_t size() const { return position.size(); }
};

class NoiseEvidence {
 public:
  NoiseEvidence(const VelocitySample& sample, double scale);

  struct Value {
    double log_determinant = 0;  // of Sigma
    double square = 0;           // y' Sigma^-1 y [m^2/s^2]
  };
  Value At(double r) const;

  // What the expected field leaves over, y - E[gain A g | y] = Sigma^-1 y; 3 N [m/s].
  Eigen::VectorXd Residual(double r) const;

  // Of each animal, what the others' velocities foretell less its own: with B its 3 x 3 block of
  // Sigma^-1, error B^-1 (Sigma^-1 y) of covariance s^2 B^-1.
  struct LeftOut {
    double error_square = 0;     // |error|^2 [m^2/s^2]
    double standard_square = 0;  // s^2 times error' (s^2 B^-1)^-1 error [m^2/s^2]
  };
  std::vector<LeftOut> LeaveOneOut(double r) const;

  // Of d log p / d log gain at the truth: its variance were the gradients normal, 2 tr S^2 with
  // S = r P^(1/2) A' Sigma^-1 A P^(1/2), and by how much that of the real ones differs, by their
  // fourth cumulants.
  struct GainScore {
    double normal = 0, excess = 0;
  };
  GainScore ScoreOfGain(double r) const;

  std::size_t equations() const { return static_cast<std::size_t>(y_.size()); }

 private:
  bool by_gradient() const { return design_.cols() < design_.rows(); }
  Eigen::MatrixXd Matrix(double r) const;  // to be factored

  Eigen::SparseMatrix<double, Eigen::RowMajor> design_;  // A P^(1/2)
  Eigen::VectorXd y_, projected_;                        // projected: P^(1/2) A' y
  Eigen::MatrixXd gram_;                                 // design' design, or design design'
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_NOISE_EVIDENCE_H_
