// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An animal's run of F frames as equations for what drives it, whose errors are independent. With
// positions seen as x_k + e_k, e of variance s^2, and a right-hand side f of all animals,
//   order 1:  dx = f dt + sqrt(2 D) dW     x_{k+1} - x_k           = sum_m Q_km f_m + n_k
//   order 2:  dv = f dt + sqrt(2 D) dW     x_{k+1} - 2 x_k + x_{k-1} = sum_m Q_km f_m + n_k
// Q integrates f over a frame (under the triangle of a second difference) to fourth order in dt
// (Adams-Moulton; Numerov). Errors have the covariance s^2 A + D B, A of the differences of white
// noise, B of the increments of a Wiener process (of the differences of its integral). With
// A U = B U Lambda, U'BU = 1, the rows U'(..) have independent errors of variance
//   s^2 lambda_j + D
// whatever s and D are: both can be sought afterwards. Nothing but the mean (and the slope) of the
// run is lost.
//
// Where the state has felt the very noise that it is regressed on, E[X'W n] is not 0. To first
// order the state z_m (the position; of order 2 the velocity (x_{m+1} - x_{m-1}) / 2 dt) is moved
// by C_ml = Cov(z_m, n_l) / D in the noise of row l, so that the right-hand side's own divergence
// g_m = df_m/dz_m makes
//   E[X'W n] = D sum_m g_m kappa_m,   kappa_m = (Q' W C')_mm,  W = (s^2 A + D B)^-1:
// without position noise, what Ito's integral has over Stratonovich's. With it W reaches over many
// frames, in which the flock forgets: what one animal has felt goes as exp(-rate t) from what its
// neighbours have, and C falls alike.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_MODES_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_MODES_H_

#include <Eigen/Core>
#include <vector>

namespace flocklift {

struct KernelModes {
  Eigen::MatrixXd difference;  // modes x F: of positions
  Eigen::MatrixXd average;     // modes x F: of f [s or s^2]; order 2: 0 in the first and last frame
  Eigen::VectorXd lambda;      // modes, increasing [1/s or 1/s^3]
  std::vector<double> rates;   // increasing from 0 [1/s]
  std::vector<Eigen::MatrixXd> shared;  // of each rate, modes x F: U'C'

  int modes() const { return static_cast<int>(lambda.size()); }
  // kappa: F x rates.
  Eigen::MatrixXd Kappa(double position_variance, double diffusion) const;
};

// The shortest run that has equations of an order.
inline constexpr int ShortestRun(int order) { return order == 1 ? 4 : 5; }

KernelModes MakeKernelModes(int order, int frames, double dt);

// C of the header for one rate, rows x F.
Eigen::MatrixXd KernelSharedNoise(int order, int frames, double dt, double rate);

// The Q of the header, rows x F.
Eigen::MatrixXd KernelQuadrature(int order, int frames, double dt);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_MODES_H_
