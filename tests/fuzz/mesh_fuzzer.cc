// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "simulate/shapes/mesh_io.h"
#include "tests/fuzz/fuzz.h"

namespace {

void CheckMesh(const flocklift::AnimatedMesh& mesh) {
  FLOCKLIFT_REQUIRE(!mesh.triangles.empty());
  for (const auto& vertices : mesh.key_frames) {
    FLOCKLIFT_REQUIRE(vertices.size() == mesh.key_frames.front().size());
    for (const auto& p : vertices) FLOCKLIFT_REQUIRE(std::isfinite(p.x + p.y + p.z));
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    FLOCKLIFT_REQUIRE(std::max({a, b, c}) < mesh.key_frames.front().size());
    FLOCKLIFT_REQUIRE(a != b && b != c && c != a);
  }
}

}  // namespace

// assimp itself loses a little memory when it refuses a file; what we look for are our own faults.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

// The first byte chooses the format, the rest is the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  if (size == 0) return 0;
  const char* const formats[] = {"m.obj", "m.ply", "m.stl", "m.gltf", "m.glb"};
  const auto path = ScratchFile(formats[data[0] % 5]);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data) + 1, static_cast<std::streamsize>(size - 1));
  AnimatedMesh mesh, again;
  if (ReadsOrRefuses(path.string(), [&] { mesh = ReadKeyFrames({path, path}); })) {
    CheckMesh(mesh);
    again = ReadKeyFrames({path});
    FLOCKLIFT_REQUIRE(again.triangles == mesh.triangles);
    FLOCKLIFT_REQUIRE(again.key_frames[0] == mesh.key_frames[0]);
  }
  if (ReadsOrRefuses(path.string(), [&] { mesh = ReadAnimation(path, 3); })) CheckMesh(mesh);
  return 0;
}
