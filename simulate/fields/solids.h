// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Solids by their signed distance: positive outside, exact everywhere [m]. They serve as obstacles
// and as goals. A union of solids is the smallest of their distances: exact outside, and inside of
// the right sign and no larger than the truth (what is deepest inside one of them).

#ifndef FLOCKLIFT_SIMULATE_FIELDS_SOLIDS_H_
#define FLOCKLIFT_SIMULATE_FIELDS_SOLIDS_H_

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <variant>

#include "simulate/core/vec3.h"
#include "simulate/fields/mesh_distance.h"

namespace flocklift {

struct Ball {
  Vec3d centre;       // [m]
  double radius = 0;  // [m]; 0 is a point

  double operator()(const Vec3d& p) const { return Norm(p - centre) - radius; }
};

struct Block {
  Vec3d low, high;  // corners of a box along the axes [m]

  double operator()(const Vec3d& p) const {
    const Vec3d q = p - 0.5 * (low + high), half = 0.5 * (high - low);
    const Vec3d beyond{std::abs(q.x) - half.x, std::abs(q.y) - half.y, std::abs(q.z) - half.z};
    const Vec3d outside{std::max(beyond.x, 0.0), std::max(beyond.y, 0.0), std::max(beyond.z, 0.0)};
    return Norm(outside) + std::min(std::max({beyond.x, beyond.y, beyond.z}), 0.0);
  }
};

// All within `radius` of the segment from a to b.
struct Capsule {
  Vec3d a, b;         // [m]
  double radius = 0;  // [m]

  double operator()(const Vec3d& p) const {
    const Vec3d axis = b - a;
    const double squared = SquaredNorm(axis);
    const double along = squared > 0 ? std::clamp(Dot(p - a, axis) / squared, 0.0, 1.0) : 0.0;
    return Norm(p - a - along * axis) - radius;
  }
};

// A round column with flat ends at a and b.
struct Cylinder {
  Vec3d a, b;         // centres of the ends, a != b [m]
  double radius = 0;  // [m]

  double operator()(const Vec3d& p) const {
    const Vec3d axis = Normalized(b - a), q = p - 0.5 * (a + b);
    const double height = Dot(q, axis);
    const double across = Norm(q - height * axis) - radius;
    const double along = std::abs(height) - 0.5 * Norm(b - a);
    return std::hypot(std::max(across, 0.0), std::max(along, 0.0)) +
           std::min(std::max(across, along), 0.0);
  }
};

// A box along the axes around all of a solid.
inline Block Bounds(const Ball& s) {
  const Vec3d r{s.radius, s.radius, s.radius};
  return {s.centre - r, s.centre + r};
}
inline Block Bounds(const Block& s) { return s; }
inline Block Bounds(const Capsule& s) {
  const Vec3d r{s.radius, s.radius, s.radius};
  return {Vec3d{std::min(s.a.x, s.b.x), std::min(s.a.y, s.b.y), std::min(s.a.z, s.b.z)} - r,
          Vec3d{std::max(s.a.x, s.b.x), std::max(s.a.y, s.b.y), std::max(s.a.z, s.b.z)} + r};
}
inline Block Bounds(const Cylinder& s) { return Bounds(Capsule{s.a, s.b, s.radius}); }
inline Block Bounds(const MeshDistance& s) { return {s.low(), s.high()}; }

using Solid = std::variant<Ball, Block, Capsule, Cylinder, MeshDistance>;

inline double SignedDistance(const Solid& solid, const Vec3d& p) {
  return std::visit([&p](const auto& shape) { return shape(p); }, solid);
}

inline Block Bounds(const Solid& solid) {
  return std::visit([](const auto& shape) { return Bounds(shape); }, solid);
}

// Of the union; infinite when there is none.
inline double SignedDistance(std::span<const Solid> solids, const Vec3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Solid& solid : solids) nearest = std::min(nearest, SignedDistance(solid, p));
  return nearest;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_SOLIDS_H_
