// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Simple solids as closed meshes.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_SOLID_MESHES_H_
#define FLOCKLIFT_SIMULATE_SHAPES_SOLID_MESHES_H_

#include "simulate/core/triangle_mesh.h"

namespace flocklift {

// The box between two corners, along the axes: 12 triangles [m].
TriangleMesh BoxMesh(const Vec3d& low, const Vec3d& high);

// A ball [m]: an octahedron whose triangles were cut in four `rounds` times, 8 * 4^rounds of them,
// with all vertices on the sphere.
TriangleMesh BallMesh(const Vec3d& centre, double radius, int rounds);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_SOLID_MESHES_H_
