// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An animated mesh as one GLB file (glTF 2.0), which Blender and browsers open: every frame after
// the first is a morph target, and an animation of the weights passes from one to the next,
// linearly in between. Frames stream to disk; memory holds one, whatever their number.
//
// With `quantize`, displacements are 16-bit shares of the extent (KHR_mesh_quantization): 8 bytes a
// vertex and frame instead of 12, good to the extent / 65 000. The JSON chunk stands before the
// data that it describes; room for it is kept, and what is left is filled with spaces.
//
// Our world is z up, glTF's y up: (x, y, z) -> (x, z, -y).

#ifndef FLOCKLIFT_SIMULATE_SHAPES_ANIMATED_MESH_WRITER_H_
#define FLOCKLIFT_SIMULATE_SHAPES_ANIMATED_MESH_WRITER_H_

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/core/vec3.h"

namespace flocklift {

struct AnimatedMeshOptions {
  double fps = 30;                               // [1/s]
  int most_frames = 1;                           // that will be added
  bool quantize = true;                          // false: floats, for readers without the extension
  double extent = 100;                           // no vertex is ever farther from its start [m]
  std::array<double, 3> colour{0.8, 0.55, 0.2};  // linear RGB, 0 .. 1
};

class AnimatedMeshWriter {
 public:
  // `triangles` run counter-clockwise seen from outside. Throws std::invalid_argument for options
  // out of range and for what would not fit into GLB's 4 GiB.
  AnimatedMeshWriter(const std::filesystem::path& path,
                     std::span<const std::array<std::uint32_t, 3>> triangles,
                     std::size_t vertex_count, const AnimatedMeshOptions& options);

  void AddFrame(std::span<const Vec3<float>> vertices);  // [m], the same number every time
  void Finish();  // without it no file appears; at least one frame

 private:
  std::string Description() const;  // the JSON chunk
  template <typename Number>
  void Put(const Number* numbers, std::size_t count);

  AnimatedMeshOptions options_;
  std::size_t vertex_count_, index_count_;
  AtomicFile file_;
  std::ofstream stream_;
  std::uint64_t json_room_, data_start_;                // [bytes]
  std::uint64_t base_offset_ = 0, targets_offset_ = 0;  // within the data
  std::vector<Vec3<float>> base_, least_, most_;        // least_, most_: of each frame as stored
  std::vector<char> buffer_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_ANIMATED_MESH_WRITER_H_
