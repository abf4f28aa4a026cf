// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/predict/motion_step.h"

#include <cmath>

namespace flocklift {

MotionStep StepOf(double correlation, double frames) {
  const double t = frames;
  MotionStep step{.frames = t};
  if (correlation <= 0) {
    step.q_pp = t * t * t / 3;
    step.q_pv = t * t / 2;
    step.q_vv = t;
    return step;
  }
  const double tau = correlation, u = t / tau;
  const double e = std::exp(-u), e2 = e * e;
  step.f_pa = tau * tau * (u - 1 + e);
  step.f_va = tau * (1 - e);
  step.f_aa = e;
  // Singer's integrals, with the variance q / (2 tau) put in.
  step.q_pp =
      0.5 * tau * tau * tau * (1 - e2 + 2 * u + 2.0 / 3 * u * u * u - 2 * u * u - 4 * u * e);
  step.q_pv = 0.5 * tau * tau * (e2 + 1 - 2 * e + 2 * u * e - 2 * u + u * u);
  step.q_pa = 0.5 * tau * (1 - e2 - 2 * u * e);
  step.q_vv = 0.5 * tau * (4 * e - 3 - e2 + 2 * u);
  step.q_va = 0.5 * (e2 + 1 - 2 * e);
  step.q_aa = 0.5 / tau * (1 - e2);
  return step;
}

}  // namespace flocklift
