// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Normals for soft shading.

#ifndef FLOCKLIFT_SIMULATE_RENDER_SOFT_NORMALS_H_
#define FLOCKLIFT_SIMULATE_RENDER_SOFT_NORMALS_H_

#include <vector>

#include "simulate/core/triangle_mesh.h"
#include "simulate/core/vec3.h"

namespace flocklift {

// At each corner of each triangle (3 T) the mean of the normals of the
// triangles that meet at its vertex, weighted by their angle there. Triangles that turn away by
// more than `crease_deg` are left out, so that the edges of a box stay sharp.
std::vector<Vec3d> SoftNormals(const TriangleMesh& mesh, double crease_deg = 40);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_SOFT_NORMALS_H_
