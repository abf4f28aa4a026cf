// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/rigid3.h"

#include <algorithm>
#include <cmath>

namespace flocklift {

Rotation3d RotationFromQuaternion(const Quaternion& q) {
  const auto& [w, x, y, z] = q;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
           2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),  //
           2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
}

Quaternion QuaternionFromRotation(const Rotation3d& rotation) {
  const auto& m = rotation.m;
  // The largest of the four squared components is at least 1/4: divide by that one (Shepperd 1978).
  const std::array<double, 4> four_squares = {1 + m[0] + m[4] + m[8], 1 + m[0] - m[4] - m[8],
                                              1 - m[0] + m[4] - m[8], 1 - m[0] - m[4] + m[8]};
  const auto largest = std::max_element(four_squares.begin(), four_squares.end());
  const double twice = std::sqrt(std::max(*largest, 0.0));
  const double s = 0.5 / twice;
  Quaternion q;
  switch (largest - four_squares.begin()) {
    case 0:
      q = {0.5 * twice, (m[7] - m[5]) * s, (m[2] - m[6]) * s, (m[3] - m[1]) * s};
      break;
    case 1:
      q = {(m[7] - m[5]) * s, 0.5 * twice, (m[1] + m[3]) * s, (m[2] + m[6]) * s};
      break;
    case 2:
      q = {(m[2] - m[6]) * s, (m[1] + m[3]) * s, 0.5 * twice, (m[5] + m[7]) * s};
      break;
    default:
      q = {(m[3] - m[1]) * s, (m[2] + m[6]) * s, (m[5] + m[7]) * s, 0.5 * twice};
  }
  return q.w < 0 ? Quaternion{-q.w, -q.x, -q.y, -q.z} : q;
}

Rotation3d WorldFromLevelBody(const Vec3d& heading_in_world) {
  Vec3d forward = Normalized(heading_in_world);
  if (forward == Vec3d{}) forward = {1, 0, 0};
  Vec3d left = Normalized(Cross(Vec3d{0, 0, 1}, forward));
  if (left == Vec3d{}) left = {1, 0, 0};
  return Rotation3d::FromRows(forward, left, Cross(forward, left)).Inverse();
}

Rigid3d LookAt(const Vec3d& position_in_world, const Vec3d& target_in_world) {
  Vec3d forward = Normalized(target_in_world - position_in_world);
  if (forward == Vec3d{}) forward = {0, 1, 0};
  Vec3d right = Normalized(Cross(forward, Vec3d{0, 0, 1}));
  if (right == Vec3d{}) right = {1, 0, 0};
  const auto rotation = Rotation3d::FromRows(right, Cross(forward, right), forward);
  return {rotation, -(rotation * position_in_world)};
}

}  // namespace flocklift
