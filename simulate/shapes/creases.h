// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Puts the creases and corners of a surface back into the boundary of a solid whose boundary
// vertices lie on that surface but whose faces cut its creases off, and then betters the shapes of
// the tetrahedra.
//
// 1. The nearest boundary vertex of every corner, and boundary vertices near a crease, move there.
// 2. A boundary edge whose ends lie on two patches of the surface with no crease vertex between
//    them is split on the crease, a face among three creases in the corner.
// 3. Every vertex in turn moves towards the mean of its neighbours, along what it belongs to (the
//    inside, a patch, a crease), when the worst tetrahedron around it gains by that.
// 4. Where a tetrahedron stays bad, an edge of it collapses, if that betters the worst one around.
// No move turns a tetrahedron inside out or makes it worse than `least_quality`.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_CREASES_H_
#define FLOCKLIFT_SIMULATE_SHAPES_CREASES_H_

#include "simulate/shapes/tetra_mesh.h"
#include "simulate/shapes/triangle_tree.h"

namespace flocklift {

struct CreaseOptions {
  double crease_angle = 0.6;    // between the normals on both sides [rad]
  double least_quality = 0.08;  // of a tetrahedron that a move may leave behind
  double bad_quality = 0.25;    // tetrahedra below are collapsed where that helps
  int smoothing_passes = 3;     // before and after the collapses
};

// `cell` is the size of the lattice's cells [m]: vertices within a part of it move to a crease.
TetraMesh RestoreCreases(const TriangleTree& surface, double cell, const CreaseOptions& options,
                         TetraMesh mesh);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_CREASES_H_
