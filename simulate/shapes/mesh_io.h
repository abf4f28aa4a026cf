// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes from files: OBJ, PLY, STL, glTF and GLB (through assimp). Polygons become triangles,
// instances are placed by their nodes' transforms, everything in one file becomes one mesh. glTF
// has y up and its world is turned to ours, z up: (x, y, z) -> (x, -z, y); the other formats keep
// their axes. One unit is one metre.
//
// Vertices at the same place are welded (formats repeat them for each triangle or normal), and
// triangles that have two corners in one vertex then are left out.
//
// InputError when a file is missing, of another format, damaged, without triangles, or has a
// coordinate that is not a number.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_MESH_IO_H_
#define FLOCKLIFT_SIMULATE_SHAPES_MESH_IO_H_

#include <filesystem>
#include <vector>

#include "simulate/core/triangle_mesh.h"
#include "simulate/shapes/animated_mesh.h"

namespace flocklift {

TriangleMesh ReadMesh(const std::filesystem::path& path);

// Key-frames, one file each. Vertices are welded where they agree in all of them. InputError also
// when a file has other triangles than the first.
AnimatedMesh ReadKeyFrames(const std::vector<std::filesystem::path>& paths);

// The animation of one glTF or GLB file, posed at `frame_count` evenly spaced times of its first
// animation: moving nodes, skins and morph targets. InputError also when it has no animation.
AnimatedMesh ReadAnimation(const std::filesystem::path& path, int frame_count);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_MESH_IO_H_
