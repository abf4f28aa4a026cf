// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an error of the focal length does to a reconstruction. A camera of focal length (1 + e) f
// sees in a scene that is stretched by (1 + e) along the optical axis what the true one sees in the
// scene itself: u = f x / z = (1 + e) f x / ((1 + e) z). The pictures cannot tell the two apart, so
// the stretch remains, and what fixes the scale decides how it is shared out:
//   known size  S = w z / f:          z by e, x and y by 0;
//   known speed, mean |v|:            the stretched scene is too fast by a e and shrinks by that,
//                                     z by (1 - a) e, x and y by -a e;
//   known distances (near, far):      z by 0, x and y by -e,
// to first order in e, where a = mean(v_z^2 / |v|) / mean|v| is the share of the motion along the
// optical axis: 0 for flight across the view, 1/3 for flight in all directions, 1 for head-on.

#ifndef FLOCKLIFT_SIMULATE_CAMERA_DEPTH_SENSITIVITY_H_
#define FLOCKLIFT_SIMULATE_CAMERA_DEPTH_SENSITIVITY_H_

#include <cmath>
#include <numbers>

namespace flocklift {

// Relative errors of depth and of the distances across the view.
struct StretchError {
  double depth = 0, across = 0;
};

inline StretchError StretchFromSize(double relative_focal_error) {
  return {relative_focal_error, 0};
}
inline StretchError StretchFromSpeed(double relative_focal_error, double share_along_axis) {
  return {(1 - share_along_axis) * relative_focal_error, -share_along_axis * relative_focal_error};
}
inline StretchError StretchFromDistances(double relative_focal_error) {
  return {0, -relative_focal_error};
}

// Relative error of the focal length from an error of the field of view, f = (w/2) / tan(fov/2):
// d f / f = -d fov / sin(fov).
inline double FocalErrorFromFov(double fov_deg, double fov_error_deg) {
  constexpr double kDegree = std::numbers::pi / 180;
  return -fov_error_deg * kDegree / std::sin(fov_deg * kDegree);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_DEPTH_SENSITIVITY_H_
