// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The frames of an animated mesh that AnimatedMeshWriter wrote, one at a time and in any order: a
// film of it needs no more memory than a frame.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_ANIMATED_MESH_FRAMES_H_
#define FLOCKLIFT_SIMULATE_SHAPES_ANIMATED_MESH_FRAMES_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

class AnimatedMeshFrames {
 public:
  // InputError for a file that is missing or was not written by AnimatedMeshWriter.
  explicit AnimatedMeshFrames(const std::filesystem::path& path);

  std::size_t frame_count() const { return offsets_.size() + 1; }
  std::size_t vertex_count() const { return base_.size(); }

  // Frame k, from 0, in our world frame [m]. May be called from several threads at once.
  std::vector<Vec3d> Frame(std::size_t k) const;

 private:
  std::string Bytes(std::uint64_t offset, std::uint64_t count) const;

  std::filesystem::path path_;
  double scale_ = 1;  // of the node [m]
  bool quantized_ = false;
  std::vector<Vec3d> base_;             // as stored
  std::vector<std::uint64_t> offsets_;  // of the displacements of frames 1, 2 ... in the file
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_ANIMATED_MESH_FRAMES_H_
