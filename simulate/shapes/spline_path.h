// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A path to move along at a known speed: a uniform cubic B-spline by its arc length.
//   p(u) = sum_k B_k(u) c_k,   s(u) = integral_0^u |p'| du
// The curve is twice continuously differentiable and cuts the corners between its control points.
// An open one starts at the first and ends at the last of them; a closed one goes round.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_SPLINE_PATH_H_
#define FLOCKLIFT_SIMULATE_SHAPES_SPLINE_PATH_H_

#include <vector>

#include "simulate/core/rigid3.h"
#include "simulate/core/vec3.h"

namespace flocklift {

class SplinePath {
 public:
  // Throws std::invalid_argument for fewer than two control points (three when closed), or when
  // they are all the same.
  SplinePath(const std::vector<Vec3d>& control, bool closed);

  double length() const { return arc_.back(); }  // [m]

  // At arc length `s` [m]: before the start and past the end an open path stays there, a closed one
  // goes on round.
  Vec3d Position(double s) const;
  Vec3d Tangent(double s) const;  // unit

  // The frame that moves along: x along the path, z up as far as possible.
  Rigid3d WorldFromPath(double s) const;

 private:
  double ParameterAt(double s) const;
  Vec3d Point(double u) const;
  Vec3d Derivative(double u) const;
  double SegmentLength(double from, double to) const;

  bool closed_;
  std::vector<Vec3d> control_;  // segment k uses k .. k + 3
  std::vector<double> arc_;     // arc length at u = 0, 1/4, 2/4, ... [m]
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_SPLINE_PATH_H_
