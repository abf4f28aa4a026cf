// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "simulate/shapes/mesh_io.h"

namespace flocklift {
namespace {

std::filesystem::path MeshPath(const std::string& name) {
  return std::filesystem::path(FLOCKLIFT_SOURCE_DIR) / "data_synthetic/meshes" / name;
}

double Volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    sum += Dot(mesh.Corner(t, 0), Cross(mesh.Corner(t, 1), mesh.Corner(t, 2))) / 6;
  }
  return sum;
}

// Edges that are not passed once in each direction.
int OpenEdges(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> passes;
  for (const auto& [a, b, c] : mesh.triangles) {
    ++passes[{a, b}];
    ++passes[{b, c}];
    ++passes[{c, a}];
  }
  int open = 0;
  for (const auto& [edge, count] : passes) {
    const auto back = passes.find({edge.second, edge.first});
    open += count != 1 || back == passes.end();
  }
  return open;
}

TEST(SceneMeshes, AreClosedAndFaceOutwards) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MeshPath(""))) {
    SCOPED_TRACE(entry.path().filename());
    const TriangleMesh mesh = ReadMesh(entry.path());
    EXPECT_EQ(OpenEdges(mesh), 0);
    EXPECT_GT(Volume(mesh), 0.05);
    EXPECT_LT(entry.file_size(), 150'000u);
    ++count;
  }
  EXPECT_GE(count, 15);
}

TEST(SceneMeshes, TheHorseRuns) {
  const AnimatedMesh horse = ReadAnimation(MeshPath("running_horse.glb"), 6);
  const double standing = Volume(ReadMesh(MeshPath("running_horse.glb")));
  double least_hoof = 1e9, most_hoof = -1e9;
  for (std::size_t k = 0; k < horse.key_frames.size(); ++k) {
    const TriangleMesh mesh = horse.Frame(k);
    EXPECT_EQ(OpenEdges(mesh), 0);
    EXPECT_NEAR(Volume(mesh), standing, 0.12 * standing);  // joints fold, nothing collapses
    double front = -1e9;
    for (const Vec3d& p : mesh.vertices) {
      if (p.z < 0.4) front = std::max(front, p.x);
    }
    least_hoof = std::min(least_hoof, front);
    most_hoof = std::max(most_hoof, front);
  }
  EXPECT_GT(most_hoof - least_hoof, 0.3);  // how far the foremost hoof travels [m]
}

}  // namespace
}  // namespace flocklift
