// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A rotation, zoom and shift of the picture: x' = a x - b y + tx, y' = b x + a y + ty.

#ifndef FLOCKLIFT_TRACK_DETECT_SIMILARITY_H_
#define FLOCKLIFT_TRACK_DETECT_SIMILARITY_H_

#include <cmath>
#include <numbers>

#include "simulate/core/vec3.h"

namespace flocklift {

struct Similarity {
  double a = 1, b = 0, tx = 0, ty = 0;

  friend bool operator==(const Similarity&, const Similarity&) = default;

  bool IsIdentity() const { return *this == Similarity{}; }
  double angle_deg() const { return std::atan2(b, a) * 180 / std::numbers::pi; }

  Vec2d operator*(const Vec2d& p) const { return {a * p.x - b * p.y + tx, b * p.x + a * p.y + ty}; }
  // First `other`, then this.
  Similarity operator*(const Similarity& other) const {
    const Vec2d t = *this * Vec2d{other.tx, other.ty};
    return {a * other.a - b * other.b, a * other.b + b * other.a, t.x, t.y};
  }
  Similarity Inverse() const {
    const double n = a * a + b * b, c = a / n, d = -b / n;
    return {c, d, -(c * tx - d * ty), -(d * tx + c * ty)};
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_SIMILARITY_H_
