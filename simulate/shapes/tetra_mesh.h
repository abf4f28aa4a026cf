// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tetrahedra: one by itself, and a solid of many that share their corners.
//
// Volume = (b - a) x (c - a) . (d - a) / 6, positive for the orientation used everywhere here.
// Shape quality = 6 sqrt(2) V / (root mean square edge)^3: 1 for the regular tetrahedron, 0 for a
// flat one, negative for one turned inside out. Radius-edge ratio = circumradius / shortest edge:
// 0.61 for the regular tetrahedron; Delaunay refinement keeps it below 2 (but lets slivers live).

#ifndef FLOCKLIFT_SIMULATE_SHAPES_TETRA_MESH_H_
#define FLOCKLIFT_SIMULATE_SHAPES_TETRA_MESH_H_

#include <array>
#include <cstdint>
#include <vector>

#include "simulate/core/triangle_mesh.h"
#include "simulate/core/vec3.h"

namespace flocklift {

using Tetra = std::array<Vec3d, 4>;  // corners [m]

double Volume(const Tetra& t);  // [m^3]
double ShapeQuality(const Tetra& t);
double RadiusEdgeRatio(const Tetra& t);   // infinite for a flat one
double SmallestDihedral(const Tetra& t);  // [rad]
Vec3d Centroid(const Tetra& t);           // of its four corners
double BoundingRadius(const Tetra& t);    // about its centroid [m]

// The faces of a tetrahedron by its corners, counter-clockwise seen from outside when its volume
// is positive; face k is the one opposite to corner k.
inline constexpr std::array<std::array<int, 3>, 4> kTetraFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct TetraMesh {
  std::vector<Vec3d> vertices;                           // V x 3 [m]
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  // N x 4, indices of vertices

  Tetra Corners(std::size_t tetra) const {
    const auto& t = tetrahedra[tetra];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]], vertices[t[3]]};
  }
};

std::vector<Tetra> Separate(const TetraMesh& mesh);  // in the mesh's order
double Volume(const TetraMesh& mesh);                // [m^3]

// The faces that belong to one tetrahedron only, oriented outwards, in the order of the
// tetrahedra. The vertices are the mesh's, those inside included.
TriangleMesh Boundary(const TetraMesh& mesh);

// The volume that a closed surface encloses [m^3].
double EnclosedVolume(const TriangleMesh& surface);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_TETRA_MESH_H_
