// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An animal at a knot as forces see it (flock_forces.h): position from the camera's first place,
// velocity, and the acceleration over the depth.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_POINT_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_POINT_H_

#include <cmath>

#include "reconstruct/cost_functions/path.h"

namespace flocklift::internal {

inline double Component(const Vec3d& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

template <typename T>
struct PathPoint {
  Vec3<T> x, v, a_over_z;
  T z;
};

template <typename T>
PathPoint<T> PointOf(const T* path, double rate, const CameraMotion& camera) {
  using std::exp;
  const PathState<T> q = StateAtKnot(path, rate);
  const T z = exp(q.l);
  const Vec3<T> w = VelocityOverDepth(q, camera);
  const Vec3d& place = camera.place;
  return {{z * q.x + place.x, z * q.y + place.y, z + place.z},
          {z * w.x, z * w.y, z * w.z},
          AccelerationOverDepth(q, camera),
          z};
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_POINT_H_
