// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the motion of an animal goes on over t frames, as the filters of kalman.h use it. Two models:
// constant velocity with white acceleration of power q, and Singer's, whose acceleration stays
// alike over a correlation time tau (a first-order Gauss-Markov process of the same power at low
// frequencies, hence of variance q / (2 tau)),
//   da/dt = -a / tau + w,   E w(t) w(s) = q / tau^2 delta(t - s).
// State (position, velocity, acceleration); with alpha = 1 / tau, u = alpha t, e = exp(-u)
//       [1  t  (u - 1 + e) / alpha^2]
//   F = [0  1  (1 - e) / alpha      ],
//       [0  0  e                    ]
//   Q = q [Q_pp Q_pv Q_pa; . Q_vv Q_va; . . Q_aa],   Q_aa = alpha (1 - e^2) / 2, ...
// For tau = 0 it is constant velocity, and the acceleration is 0.
// R. A. Singer, "Estimating optimal tracking filter performance for manned maneuvering targets",
// IEEE Trans. Aerospace and Electronic Systems 6, 1970.

#ifndef FLOCKLIFT_TRACK_PREDICT_MOTION_STEP_H_
#define FLOCKLIFT_TRACK_PREDICT_MOTION_STEP_H_

namespace flocklift {

struct MotionStep {
  double frames = 1;
  double f_pa = 0, f_va = 0, f_aa = 0;  // F: what the acceleration does to each
  double q_pp = 0, q_pv = 0, q_vv = 0;  // Q of unit power, per axis
  double q_pa = 0, q_va = 0, q_aa = 0;
};

// `correlation` is tau [frames], at most about 1000 t: beyond, digits are lost.
MotionStep StepOf(double correlation, double frames = 1);

// q / (2 tau); 0 where there is no acceleration to be known [px^2/frame^4].
inline double AccelerationVariance(double q, double correlation) {
  return correlation > 0 ? 0.5 * q / correlation : 0;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_PREDICT_MOTION_STEP_H_
