// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fills a closed surface with tetrahedra by isosurface stuffing (Labelle, Shewchuk, SIGGRAPH 2007),
// uniform form: the body-centred cubic lattice, whose tetrahedra are all alike; lattice points near
// the surface are pulled onto it; tetrahedra that stick out are trimmed where their edges cross it.
// Every tetrahedron is well shaped and the surface is met at all vertices of the boundary, but its
// creases are cut off over about a cell: simulate/shapes/creases.h puts them back.
//
// Ours: inside is where the winding number along a lattice line is positive, so closed surfaces may
// overlap; the diagonal of a trimmed quadrilateral ends in its longer cut edge (nearly the shorter
// diagonal, and never cyclic around a prism).

#ifndef FLOCKLIFT_SIMULATE_SHAPES_LATTICE_FILL_H_
#define FLOCKLIFT_SIMULATE_SHAPES_LATTICE_FILL_H_

#include "simulate/shapes/tetra_mesh.h"
#include "simulate/shapes/triangle_tree.h"

namespace flocklift {

// `cell` is the edge of the lattice's cubes [m]; a cube holds 12 tetrahedra. Parts of the surface
// thinner than about a cell may be lost. Vertices on the surface are where `Boundary` has them.
TetraMesh FillWithLattice(const TriangleTree& surface, double cell);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_LATTICE_FILL_H_
