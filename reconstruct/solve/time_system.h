// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Normal equations of many paths that act on each other: unknowns in order of time, those of all
// animals at one time in a block. A residual spans at most four blocks on end (the control points
// of a spline's interval), so that the matrix is banded by blocks; a border holds what belongs to
// no time:
//   [ A    U ] [dx]   [ -g_x ]      A: block (t, t - d), d = 0 .. 3, symmetric
//   [ U^T  D ] [db] = [ -g_b ]
// Cholesky of a block band: linear in time, cubic in the animals at one time. Covariances by the
// selected inverse (Takahashi, Fagan and Chin, 1973), block by block.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_TIME_SYSTEM_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_TIME_SYSTEM_H_

#include <Eigen/Core>
#include <array>
#include <vector>

namespace flocklift::internal {

class TimeSystem {
 public:
  static constexpr int kSpan = 4;  // blocks that one residual may touch

  TimeSystem(const std::vector<int>& widths, int border);

  int times() const { return static_cast<int>(band_.size()); }
  int width(int time) const { return static_cast<int>(gradient_[Index(time)].size()); }
  int border() const { return static_cast<int>(corner_.rows()); }

  void SetZero();
  // To be added to: block (time, time - d), of which the lower triangle counts where d is 0; what
  // couples a time to the border; the border's own; the gradient.
  Eigen::MatrixXd& Block(int time, int d) { return band_[Index(time)][Index(d)]; }
  Eigen::MatrixXd& ToBorder(int time) { return to_border_[Index(time)]; }
  Eigen::MatrixXd& Corner() { return corner_; }
  Eigen::VectorXd& Gradient(int time) { return gradient_[Index(time)]; }
  Eigen::VectorXd& BorderGradient() { return border_gradient_; }

  // Factorises with damping: every diagonal entry times 1 + damping, but every third of a block
  // plus damping * depth_metric (arrow_system.h). False where it is not positive definite.
  bool Factorise(double damping, double depth_metric);
  // After Factorise: the step, time by time and of the border.
  struct Step {
    std::vector<Eigen::VectorXd> at;
    Eigen::VectorXd border;
  };
  Step Solve() const;

  // After Factorise: covariances of all that one residual can touch.
  struct Posterior {
    std::vector<std::array<Eigen::MatrixXd, kSpan>> band;  // inverse of A, where A has blocks
    std::vector<Eigen::MatrixXd> to_border;                // A^-1 U
    Eigen::MatrixXd border;
  };
  Posterior Covariance() const;
  // Of a sum of unknowns, weights time by time.
  double Variance(const std::vector<Eigen::VectorXd>& weights) const;

 private:
  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }

  std::vector<std::array<Eigen::MatrixXd, kSpan>> band_, factor_;
  std::vector<Eigen::MatrixXd> to_border_, reduced_border_;
  std::vector<Eigen::VectorXd> gradient_, reduced_gradient_;
  Eigen::MatrixXd corner_, corner_factor_;
  Eigen::VectorXd border_gradient_, border_step_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_TIME_SYSTEM_H_
