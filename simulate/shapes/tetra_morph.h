// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From one tetrahedron to another without detours (equations.md, section 7). The affine map between
// them is A = E' E^-1, E = [p2 - p1, p3 - p1, p4 - p1]; its polar factors are A = R S, a rotation
// by theta about n and a symmetric positive stretch. In between, 0 <= t <= 1,
//   published  A(t) = (1 - t) I + t R(n, t theta) S
//   shoemake   A(t) = R(n, t theta) ((1 - t) I + t S)       (Shoemake, Duff, Graphics Interface
//   1992)
// Both are I at 0 and A at 1; the second never turns a tetrahedron inside out on its way.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_TETRA_MORPH_H_
#define FLOCKLIFT_SIMULATE_SHAPES_TETRA_MORPH_H_

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "simulate/shapes/tetra_mesh.h"

namespace flocklift {

enum class MorphKind { kPublished, kShoemake };

struct PolarFactors {
  glm::dmat3 rotation, stretch;
};

// A = rotation * stretch by Higham's scaled Newton iteration (SIAM J. Sci. Stat. Comput. 7, 1986).
// det A > 0.
PolarFactors PolarDecompose(const glm::dmat3& a);

// The affine part of the map that takes `from` to `to`, both positively oriented.
glm::dmat3 AffineBetween(const Tetra& from, const Tetra& to);

// `to` with its corners in that one of the 12 orders of the same orientation which turns `from`
// least: sum over corners of (p - centroid) . (p' - centroid') is greatest.
Tetra MatchCorners(const Tetra& from, const Tetra& to);

// The map in between, ready to be asked for many t.
struct TetraMorph {
  glm::dvec3 axis{0, 0, 1};  // unit
  double angle = 0;          // theta, in [0, pi] [rad]
  glm::dmat3 stretch{1};

  TetraMorph() = default;
  TetraMorph(const Tetra& from, const Tetra& to);

  glm::dmat3 At(double t, MorphKind kind) const;  // A(t)
};

// The tetrahedron at t: its first corner goes straight, the others as A(t) has it.
Tetra TetraBetween(const Tetra& from, const Tetra& to, double t, MorphKind kind);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_TETRA_MORPH_H_
