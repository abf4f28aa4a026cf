// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/predict/smoother.h"

#include "simulate/core/check.h"

namespace flocklift {

std::vector<MotionState> Smooth(std::span<const Measurement> measurements, double q,
                                double speed_sd) {
  FLOCKLIFT_DCHECK(!measurements.empty());
  const int first = measurements.front().frame, last = measurements.back().frame;
  std::vector<MotionState> states;  // filtered, from the last one back smoothed
  states.reserve(static_cast<std::size_t>(last - first + 1));
  MotionState state{
      measurements.front().position, {0, 0}, measurements.front().variance, 0, speed_sd * speed_sd};
  std::size_t next = 1;
  states.push_back(state);
  for (int frame = first + 1; frame <= last; ++frame) {
    Predict(&state, q * measurements[next].agility);
    if (measurements[next].frame == frame) {
      Update(&state, measurements[next].position, measurements[next].variance);
      ++next;
    }
    states.push_back(state);
  }

  // x_k <- x_k + G (x_{k+1} - F x_k),  P_k <- P_k + G (P_{k+1} - P_{k+1|k}) G',
  // G = P_k F' P_{k+1|k}^-1.
  next = measurements.size() - 1;
  for (int k = last - first - 1; k >= 0; --k) {
    if (measurements[next - 1].frame > first + k) --next;  // the one that k + 1 leads to
    const MotionState f = states[k];
    MotionState p = f;
    Predict(&p, q * measurements[next].agility);
    const MotionState& s = states[k + 1];
    const double det = p.pp * p.vv - p.pv * p.pv;
    const double a = f.pp + f.pv, b = f.pv, c = f.pv + f.vv, d = f.vv;  // P_k F'
    const double g00 = (a * p.vv - b * p.pv) / det, g01 = (b * p.pp - a * p.pv) / det;
    const double g10 = (c * p.vv - d * p.pv) / det, g11 = (d * p.pp - c * p.pv) / det;
    const Vec2d dx{s.position.x - p.position.x, s.position.y - p.position.y};
    const Vec2d dv{s.velocity.x - p.velocity.x, s.velocity.y - p.velocity.y};
    MotionState& out = states[k];
    out.position = {f.position.x + g00 * dx.x + g01 * dv.x, f.position.y + g00 * dx.y + g01 * dv.y};
    out.velocity = {f.velocity.x + g10 * dx.x + g11 * dv.x, f.velocity.y + g10 * dx.y + g11 * dv.y};
    const double m00 = s.pp - p.pp, m01 = s.pv - p.pv, m11 = s.vv - p.vv;
    const double h00 = g00 * m00 + g01 * m01, h01 = g00 * m01 + g01 * m11;
    const double h10 = g10 * m00 + g11 * m01, h11 = g10 * m01 + g11 * m11;
    out.pp = f.pp + h00 * g00 + h01 * g01;
    out.pv = f.pv + h00 * g10 + h01 * g11;
    out.vv = f.vv + h10 * g10 + h11 * g11;
  }
  return states;
}

}  // namespace flocklift
