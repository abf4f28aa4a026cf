// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Coefficients c of kernels, noise and smoothness from the normal equations of kernel_moments.h:
//   y | c ~ N(X c, s^2 lambda + D),   c ~ N(0, (sum_g tau_g P_g)^-1)
// s^2, D and every tau_g of greatest marginal likelihood: the noise by its restricted likelihood,
// tau_g by the steps of Wood and Fasiolo ("A generalized Fellner-Schall method", Biometrics 2017),
//   tau_g <- tau_g (tr(S^- P_g) - tr(V P_g)) / (c' P_g c),   S = sum_g tau_g P_g.
// V = (sum_b M_b / v_b + S)^-1 is the posterior covariance, whose bands cover on average over the
// function, what is too smooth for the truth included (Nychka 1988), if S is right. Where a kernel
// bends little the data hardly bound tau from above, and the likeliest is near infinity: so for V
// every tau is as small as the likelihood allows within one standard error (its -2 log 1 above the
// least).
//
// With moments that noise of the positions has been taken out of, A c = r is solved with these; the
// residuals are of the plain ones, and V A^- (A_plain - A) A^- more (Fuller, "Measurement error
// models", 1987): what the errors of the features add.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_EVIDENCE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_EVIDENCE_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "reconstruct/fit/kernel_moments.h"

namespace flocklift {

struct KernelEvidence {
  Eigen::VectorXd coefficients;  // c
  Eigen::MatrixXd covariance;    // of c
  Eigen::MatrixXd h;             // H c = r is what c solves: data and penalties
  Eigen::VectorXd r;
  Eigen::VectorXd information;   // of each coefficient by itself, from the data
  double position_variance = 0;  // s^2 [m^2]
  double diffusion = 0;          // D
  double effective = 0;          // parameters that the data decide: tr(V sum_b M_b / v_b)
  double explained = 0;          // 1 - sum r^2 / v over sum y^2 / v
  bool converged = false;
};

struct KernelPenalties {
  std::vector<Eigen::MatrixXd> parts;  // P_g, terms x terms each, positive semi-definite
  // As many coefficients as S has dimensions that it leaves free, and that would be fixed with
  // these (the ends of a line). S with them held is regular, and a generalized inverse of it.
  std::vector<Eigen::Index> pins;
};

// `plain` are the moments as they came, `corrected` without what position noise has put in (the
// same object when there is none). `position_variance`: s^2 where it is known [m^2], held.
KernelEvidence SolveKernels(const KernelMoments& plain, const KernelMoments& corrected,
                            const KernelPenalties& penalties,
                            std::optional<double> position_variance = std::nullopt);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_EVIDENCE_H_
