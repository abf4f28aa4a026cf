// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/orientation.h"

#include <algorithm>
#include <cmath>

namespace flocklift {

Rotation3d WorldFromFlyingBody(const Vec3d& velocity, const Vec3d& acceleration, const Vec3d& up) {
  constexpr double kGravity = 9.81;    // [m/s^2]
  constexpr double kMostBank = 2.747;  // tan 70 degrees
  const Vec3d any = std::abs(up.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  Vec3d forward = Normalized(velocity);
  if (forward == Vec3d{}) forward = Normalized(any - Dot(any, up) * up);
  Vec3d left = Normalized(Cross(up, forward));
  if (left == Vec3d{}) left = Normalized(Cross(up, any));  // straight up or down
  left = Normalized(left - Dot(left, forward) * forward);
  const Vec3d level_up = Cross(forward, left);
  const double tangent = std::clamp(Dot(acceleration, left) / kGravity, -kMostBank, kMostBank);
  const Vec3d body_up = Normalized(level_up + tangent * left);
  return Rotation3d::FromRows(forward, Cross(body_up, forward), body_up).Inverse();
}

}  // namespace flocklift
