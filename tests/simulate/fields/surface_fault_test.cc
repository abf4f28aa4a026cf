// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/surface_fault.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/simulate/fields/meshes.h"

namespace flocklift {
namespace {

using ::testing::HasSubstr;
using ::testing::Optional;

const TriangleMesh kCube = BoxMesh({0, 0, 0}, {1, 1, 1});

TEST(SurfaceFault, ClosedMeshesHaveNone) {
  for (const NamedMesh& mesh : ManyMeshes()) {
    EXPECT_EQ(SurfaceFault(mesh.mesh), std::nullopt) << mesh.name;
  }
}

TEST(SurfaceFault, AHoleIsNamedByItsEdge) {
  TriangleMesh mesh = kCube;
  mesh.triangles.pop_back();  // {3, 7, 5}
  EXPECT_THAT(SurfaceFault(mesh),
              Optional(HasSubstr("edge between vertices 3 and 5 belongs to one triangle only")));
}

TEST(SurfaceFault, ATurnedTriangleIsFound) {
  TriangleMesh mesh = kCube;
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  EXPECT_THAT(SurfaceFault(mesh), Optional(HasSubstr("in the same direction")));
}

TEST(SurfaceFault, AnEdgeOfFourTrianglesIsFound) {
  TriangleMesh mesh = kCube;  // a second cube that shares the edge of vertices 3 and 7
  TriangleMesh other = BoxMesh({1, 1, 0}, {2, 2, 1});
  Append(other, &mesh);
  for (auto& triangle : mesh.triangles) {
    for (auto& corner : triangle) corner = corner == 8 ? 3 : corner == 12 ? 7 : corner;
  }
  EXPECT_THAT(SurfaceFault(mesh),
              Optional(HasSubstr("edge between vertices 3 and 7 belongs to 4 triangles")));
}

TEST(SurfaceFault, SurfacesMayTouchAtAVertex) {
  EXPECT_EQ(SurfaceFault(KissingMesh()), std::nullopt);
}

TEST(SurfaceFault, InsideOutIsFound) {
  EXPECT_THAT(SurfaceFault(Inverted(kCube)), Optional(HasSubstr("inside out")));
}

TEST(SurfaceFault, BadCornersAreFound) {
  EXPECT_THAT(SurfaceFault({}), Optional(HasSubstr("no triangle")));
  TriangleMesh mesh = kCube;
  mesh.triangles[2][1] = 8;
  EXPECT_THAT(SurfaceFault(mesh), Optional(HasSubstr("triangle 2 names vertex 8")));
  mesh.triangles[2][1] = mesh.triangles[2][0];
  EXPECT_THAT(SurfaceFault(mesh), Optional(HasSubstr("triangle 2 has no area")));
  mesh.vertices[4].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(SurfaceFault(mesh), Optional(HasSubstr("vertex 4 is not finite")));
}

}  // namespace
}  // namespace flocklift
