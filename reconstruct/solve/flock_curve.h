// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a flock has in common and changes over time (its speed, its acceleration, the depth of its
// middle): linear between knots, whose values are among the unknowns of the whole flock.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_FLOCK_CURVE_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_FLOCK_CURVE_H_

#include <algorithm>
#include <array>
#include <cmath>

namespace flocklift::internal {

struct FlockCurve {
  int first = 0;        // place of the first knot's first value among the flock's unknowns
  int knots = 0;        // 0: there is no such curve
  int width = 1;        // values at a knot
  double interval = 1;  // between knots [s]

  int size() const { return knots * width; }
  int end() const { return first + size(); }

  // As many knots as it takes to reach `last_time`.
  static FlockCurve Until(double last_time, int first, int width, double interval) {
    return {first, static_cast<int>(std::ceil(last_time / interval)) + 1, width, interval};
  }

  // value(time) = sum of weight * unknown[index]; past the ends it stays as it is there.
  struct Share {
    int index;
    double weight;
  };
  std::array<Share, 2> At(double time, int axis) const {
    const double place = std::clamp(time / interval, 0.0, knots - 1.0);
    const int left = std::min(static_cast<int>(place), std::max(0, knots - 2));
    const int right = std::min(left + 1, knots - 1);
    return {Share{first + width * left + axis, 1 - (place - left)},
            Share{first + width * right + axis, place - left}};
  }
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_FLOCK_CURVE_H_
