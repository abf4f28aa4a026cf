// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/soft_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace flocklift {
namespace {

TriangleMesh Globe(int rings) {
  TriangleMesh mesh;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      const double polar = std::numbers::pi * i / rings, azimuth = std::numbers::pi * j / rings;
      mesh.vertices.push_back({std::sin(polar) * std::cos(azimuth),
                               std::sin(polar) * std::sin(azimuth), std::cos(polar)});
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(i * 2 * rings + j % (2 * rings));
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < rings) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
  return mesh;
}

TEST(SoftNormals, OfAGlobeAreRadial) {
  const TriangleMesh globe = Globe(24);
  const std::vector<Vec3d> normals = SoftNormals(globe);
  ASSERT_EQ(normals.size(), 3 * globe.triangles.size());
  for (std::size_t k = 0; k < normals.size(); ++k) {
    const Vec3d radial = globe.Corner(k / 3, k % 3);
    if (std::abs(radial.z) > 0.99) continue;  // poles are many vertices
    EXPECT_GT(Dot(normals[k], radial), 0.999) << k;
  }
}

TEST(SoftNormals, KeepTheEdgesOfABox) {
  TriangleMesh box;
  for (int k = 0; k < 8; ++k) {
    box.vertices.push_back({double(k & 1), double(k >> 1 & 1), double(k >> 2 & 1)});
  }
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const std::vector<Vec3d> normals = SoftNormals(box);
  for (std::size_t t = 0; t < 12; ++t) {
    const Vec3d face =
        Normalized(Cross(box.Corner(t, 1) - box.Corner(t, 0), box.Corner(t, 2) - box.Corner(t, 0)));
    EXPECT_GT(Dot(face, box.Corner(t, 0) - Vec3d{0.5, 0.5, 0.5}), 0);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(Dot(normals[3 * t + c], face), 1, 1e-12);
  }
}

}  // namespace
}  // namespace flocklift
