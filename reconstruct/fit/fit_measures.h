// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is said of a fit besides its weights: how well it predicts, what noise it leaves over, which
// directions of the weights the data determine best and worst. theta holds the p weights.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_FIT_MEASURES_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_FIT_MEASURES_H_

#include <optional>
#include <vector>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/motion_rows.h"
#include "reconstruct/fit/whitened_fit.h"

namespace flocklift {

// Per component; 0 for none.
double MeanSquare(const std::vector<Vec3d>& values);

// c_i of each animal, sum g u / sum g n with g the direction foreseen; NaN for an animal without
// rows. `animals`: how many there are.
std::vector<double> OwnFactors(const MotionRows& rows, const std::vector<double>& theta,
                               int animals);

// 1 - sum |y - b yhat|^2 / sum |y|^2 over frames after `split`, where yhat is the acceleration that
// weights fitted to frames before `split` expect of the states foreseen before each window, and b,
// from before `split` too, makes up for the noise of those states. 0 is constant velocity.
std::optional<double> HeldOutR2(const WhiteningOptions& whitening, const MotionRows& rows,
                                int split, int animals);

// Share of u that a pull to the mean position explains; 0 when it points outwards.
double PullToTheMiddle(const MotionRows& rows, const std::vector<Vec3d>& u);

// The noise behind u: Ornstein-Uhlenbeck when the fit has a rho, otherwise white, told from
// position noise by u's covariances over 0 and m frames (under the triangle V and V / 4 for white
// noise, 6 M and -4 M for position noise).
struct NoiseEstimate {
  double sd = 0;         // [m/s^2]; of one engine step when fresh at every step
  double time = 0;       // correlation time [s]; 0: fresh at every step
  double diffusion = 0;  // of the velocity, when white [m^2/s^3]
};
NoiseEstimate EstimateNoise(const MotionRows& rows, const std::vector<Vec3d>& u,
                            const std::optional<double>& rho, double dt, double engine_step);

// What a handful of roundings in single precision, in which flocks fly, make of a number: no
// parameter can be known better.
double RoundingOf(double value);

// Of each term's mean square, the share by which other positions of the same animals change it:
// mean |X' - X|^2 / mean |X|^2 over the rows that both have.
std::vector<double> ChangedShares(const MotionRows& rows, const MotionRows& other);

// The values to fly by: the most probable weights when an estimate counts as N(theta, covariance)
// and, beforehand, no term is thought to make more than all the acceleration there is, N(0, (a /
// rms)^2), and weights marked `positive` not to be negative. Where the data determine a weight this
// changes nothing; where they do not, it keeps a flock from flying apart. A weight of infinite sd
// stays.
std::vector<double> ProbableWeights(const RegressionResult& regression,
                                    const std::vector<double>& rms, double acceleration_rms,
                                    const std::vector<bool>& positive);

// Eigenvectors of the covariance of the weights times their terms' rms [m/s^2], smallest or largest
// eigenvalue; weights of infinite sd have no part.
FitDirection BestDirection(const RegressionResult& regression, const std::vector<double>& rms);
FitDirection WorstDirection(const RegressionResult& regression, const std::vector<double>& rms);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_FIT_MEASURES_H_
