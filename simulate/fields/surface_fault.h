// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether a mesh bounds a solid. Only a closed, oriented surface has an inside, and only then does
// a distance to it have a sign.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_SURFACE_FAULT_H_
#define FLOCKLIFT_SIMULATE_FIELDS_SURFACE_FAULT_H_

#include <optional>
#include <string>

#include "simulate/core/triangle_mesh.h"

namespace flocklift {

// The first thing that keeps `mesh` from being the boundary of a solid, in a few words for an
// InputError ("the edge between vertices 3 and 7 belongs to one triangle only"; triangles and
// vertices count from 0); nothing when it is one. Every edge must belong to two triangles that run
// along it in opposite directions, every triangle needs an area, and the volume must be positive.
// Several surfaces are allowed (a hollow ball), and they may touch at vertices.
std::optional<std::string> SurfaceFault(const TriangleMesh& mesh);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_SURFACE_FAULT_H_
