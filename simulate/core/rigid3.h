// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rotations and rigid transforms. A transform is named target_from_source, and adjacent frames
// cancel: point_in_cam = cam_from_world * point_in_world.

#ifndef FLOCKLIFT_SIMULATE_CORE_RIGID3_H_
#define FLOCKLIFT_SIMULATE_CORE_RIGID3_H_

#include <array>

#include "simulate/core/vec3.h"

namespace flocklift {

// A 3 x 3 rotation, row-major: row k is the target's axis k in the source frame.
template <typename T>
struct Rotation3 {
  std::array<T, 9> m{T(1), T(0), T(0), T(0), T(1), T(0), T(0), T(0), T(1)};

  constexpr Vec3<T> operator*(const Vec3<T>& p) const {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z, m[3] * p.x + m[4] * p.y + m[5] * p.z,
            m[6] * p.x + m[7] * p.y + m[8] * p.z};
  }
  constexpr Rotation3 Inverse() const {
    return {{m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}};
  }
  static constexpr Rotation3 FromRows(const Vec3<T>& x, const Vec3<T>& y, const Vec3<T>& z) {
    return {{x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z}};
  }
  friend constexpr bool operator==(const Rotation3&, const Rotation3&) = default;
};

// point_in_target = rotation * point_in_source + translation.
template <typename T>
struct Rigid3 {
  Rotation3<T> rotation;
  Vec3<T> translation;

  constexpr Vec3<T> operator*(const Vec3<T>& p) const { return rotation * p + translation; }
  constexpr Rigid3 Inverse() const {
    const Rotation3<T> inverse = rotation.Inverse();
    return {inverse, -(inverse * translation)};
  }
  friend constexpr bool operator==(const Rigid3&, const Rigid3&) = default;
};

using Rotation3d = Rotation3<double>;
using Rigid3d = Rigid3<double>;

// Unit quaternion w + xi + yj + zk.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;

  friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

// The rotation of a unit quaternion, and back (w >= 0).
Rotation3d RotationFromQuaternion(const Quaternion& q);
Quaternion QuaternionFromRotation(const Rotation3d& rotation);

// world_from_body of an animal that flies along `heading_in_world` with its wings level: body x
// forward, z up. A vertical heading keeps +x of the world as its side.
Rotation3d WorldFromLevelBody(const Vec3d& heading_in_world);

// cam_from_world of a camera at `position` whose optical axis meets `target`, image up = world +z
// as far as possible.
Rigid3d LookAt(const Vec3d& position_in_world, const Vec3d& target_in_world);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_RIGID3_H_
