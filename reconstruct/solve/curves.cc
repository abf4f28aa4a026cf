// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/curves.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/cost_functions/path.h"

namespace flocklift::internal {

void UpdateCurves(const BatchModel& model, std::vector<Bird>* birds) {
  constexpr double kGravity = 9.81;  // [m/s^2]
  constexpr double kHalf = 0.3;      // accelerations are averaged so long before and after [s]
  const double rate = 1 / model.knot_interval;
  const int half = static_cast<int>(std::lround(kHalf * rate));
  for (Bird& bird : *birds) {
    std::vector<Vec3d> sums(bird.curve.size() + 1);  // of all knots before
    for (std::size_t knot = 0; knot < bird.curve.size(); ++knot) {
      const PathState<double> q = StateAtKnot(&bird.path[3 * knot], rate);
      const double time = (bird.first_knot + static_cast<double>(knot)) * model.knot_interval;
      sums[knot + 1] =
          sums[knot] + std::exp(q.l) / kGravity * AccelerationOverDepth(q, model.camera.At(time));
    }
    const int knots = static_cast<int>(bird.curve.size());
    for (int knot = 0; knot < knots; ++knot) {
      const int first = std::max(0, knot - half), end = std::min(knots, knot + half + 1);
      bird.curve[static_cast<std::size_t>(knot)] =
          (1.0 / (end - first)) *
          (sums[static_cast<std::size_t>(end)] - sums[static_cast<std::size_t>(first)]);
    }
  }
}

}  // namespace flocklift::internal
