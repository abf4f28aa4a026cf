// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/mesh_io.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "tests/simulate/core/fault.h"
#include "tests/simulate/shapes/small_gltf.h"

namespace flocklift {
namespace {

double Volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    sum += Dot(mesh.Corner(t, 0), Cross(mesh.Corner(t, 1), mesh.Corner(t, 2))) / 6;
  }
  return sum;
}

// A box of 1 x 2 x 3, its sides as quadrangles.
const char* const kBoxObj =
    "o box\nv 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 3\nv 1 0 3\nv 1 2 3\nv 0 2 3\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

// A tetrahedron.
const char* const kTetrahedronPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

class MeshIo : public testing::Test {
 protected:
  std::filesystem::path Write(const std::string& name, const std::string& text) {
    WriteTextFile(folder_ / name, text);
    return folder_ / name;
  }
  // What ReadMesh says of the file.
  std::string Complaint(const std::filesystem::path& path) {
    try {
      ReadMesh(path);
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.substr(0, path.string().size() + 2), path.string() + ": ");
      EXPECT_NE(message.find("; "), std::string::npos) << message;
      return message;
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(MeshIo, ObjQuadranglesBecomeWeldedTriangles) {
  const TriangleMesh mesh = ReadMesh(Write("box.obj", kBoxObj));
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NEAR(Volume(mesh), 6, 1e-6);
}

TEST_F(MeshIo, Ply) {
  const TriangleMesh mesh = ReadMesh(Write("t.PLY", kTetrahedronPly));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(Volume(mesh), 1.0 / 6, 1e-7);
  EXPECT_EQ(mesh.vertices[3], (Vec3d{0, 0, 1}));
}

TEST_F(MeshIo, StlOfLooseTrianglesIsWelded) {
  std::string text = "solid t\n";
  for (const char* corners : {"0 0 0|0 1 0|1 0 0", "0 0 0|1 0 0|0 0 1", "0 0 0|0 0 1|0 1 0",
                              "1 0 0|0 1 0|0 0 1", "1 0 0|1 0 0|0 0 1"}) {
    text += "facet normal 0 0 0\nouter loop\nvertex ";
    for (const char* c = corners; *c != 0; ++c) {
      text += *c == '|' ? std::string("\nvertex ") : std::string(1, *c);
    }
    text += "\nendloop\nendfacet\n";
  }
  const TriangleMesh mesh = ReadMesh(Write("t.stl", text + "endsolid t\n"));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u) << "the fifth has two corners in one vertex";
  EXPECT_NEAR(Volume(mesh), 1.0 / 6, 1e-7);
}

TEST_F(MeshIo, GltfIsPlacedByItsNodesAndTurnedUpright) {
  SmallGltf gltf;
  gltf.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  gltf.Shorts({0, 1, 2}, "SCALAR");
  gltf.Write(
      folder_ / "t.gltf",
      "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1}]}],"
      "\"nodes\": [{\"children\": [1], \"translation\": [10, 0, 0]},"
      "{\"mesh\": 0, \"scale\": [2, 2, 2], \"translation\": [0, 3, 0]},"
      "{\"mesh\": 0, \"scale\": [-1, 1, 1]}], \"scenes\": [{\"nodes\": [0, 2]}]");
  const TriangleMesh mesh = ReadMesh(folder_ / "t.gltf");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  // y up: (x, y, z) of the file is (x, -z, y) here.
  EXPECT_EQ(mesh.Corner(0, 0), (Vec3d{10, 0, 3}));
  EXPECT_EQ(mesh.Corner(0, 1), (Vec3d{12, 0, 3}));
  EXPECT_EQ(mesh.Corner(0, 2), (Vec3d{10, 0, 5}));
  // The mirrored copy faces the same way.
  const auto normal = [&mesh](std::size_t t) {
    return Cross(mesh.Corner(t, 1) - mesh.Corner(t, 0), mesh.Corner(t, 2) - mesh.Corner(t, 0));
  };
  EXPECT_LT(normal(0).y, 0);
  EXPECT_LT(normal(1).y, 0);
}

TEST_F(MeshIo, KeyFramesShareTheirTopology) {
  const std::string moved = std::string(kTetrahedronPly)
                                .replace(std::string(kTetrahedronPly).find("0 0 1\n3"), 5, "0 0 2");
  const AnimatedMesh mesh = ReadKeyFrames({Write("0.ply", kTetrahedronPly), Write("1.ply", moved)});
  ASSERT_EQ(mesh.key_frames.size(), 2u);
  EXPECT_EQ(mesh.key_frames[1][3], (Vec3d{0, 0, 2}));
  EXPECT_EQ(VerticesAt(mesh, 0.25)[3], (Vec3d{0, 0, 1.25}));
  EXPECT_EQ(VerticesAt(mesh, 1.25)[3], (Vec3d{0, 0, 1.75}));  // and back to the first
  EXPECT_EQ(VerticesAt(mesh, -1.75)[3], (Vec3d{0, 0, 1.25}));
}

TEST_F(MeshIo, WeldingLooksAtAllKeyFrames) {
  // Two triangles that touch in the first frame and part in the second.
  const std::string touching =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 4 6 5\n";
  const std::string apart =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 5\nv 1 1 5\nf 1 2 3\nf 4 6 5\n";
  EXPECT_EQ(ReadMesh(Write("0.obj", touching)).vertices.size(), 4u);
  EXPECT_EQ(ReadKeyFrames({folder_ / "0.obj", Write("1.obj", apart)}).key_frames[0].size(), 5u);
}

TEST_F(MeshIo, MorphTargetsAreSampled) {
  SmallGltf gltf;
  gltf.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  gltf.Shorts({0, 1, 2}, "SCALAR");
  gltf.Floats({0, 0, 0, 4, 0, 0, 0, 0, 0}, "VEC3");  // displacement of the target
  gltf.Floats({0, 2}, "SCALAR");                     // times
  gltf.Floats({0, 1}, "SCALAR");                     // weights
  gltf.Write(
      folder_ / "m.gltf",
      "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1,"
      "\"targets\": [{\"POSITION\": 2}]}], \"weights\": [0]}],"
      "\"nodes\": [{\"mesh\": 0, \"name\": \"body\"}], \"scenes\": [{\"nodes\": [0]}],"
      "\"animations\": [{\"samplers\": [{\"input\": 3, \"output\": 4}],"
      "\"channels\": [{\"sampler\": 0, \"target\": {\"node\": 0, \"path\": \"weights\"}}]}]");
  const AnimatedMesh mesh = ReadAnimation(folder_ / "m.gltf", 4);
  ASSERT_EQ(mesh.key_frames.size(), 4u);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(mesh.key_frames[static_cast<std::size_t>(k)][1].x, 1 + 4 * k / 4.0, 1e-6);
  }
}

TEST_F(MeshIo, MovingNodesAndSkinsAreSampled) {
  SmallGltf gltf;
  gltf.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  gltf.Shorts({0, 1, 2}, "SCALAR");
  gltf.Floats({0, 2}, "SCALAR");
  gltf.Floats({0, 0, 0, 0, 0, 8}, "VEC3");                        // translations
  gltf.Shorts({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC4");      // joints
  gltf.Floats({1, 0, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0, 0}, "VEC4");  // weights
  const std::vector<float> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::vector<float> bind = identity;
  bind.insert(bind.end(), identity.begin(), identity.end());
  gltf.Floats(bind, "MAT4");
  const std::string moves =
      "\"animations\": [{\"samplers\": [{\"input\": 2, \"output\": 3}],"
      "\"channels\": [{\"sampler\": 0, \"target\": {\"node\": 1, \"path\": \"translation\"}}]}],";
  gltf.Write(folder_ / "node.gltf",
             moves +
                 "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0},"
                 "\"indices\": 1}]}], \"nodes\": [{\"children\": [1]}, {\"mesh\": 0}],"
                 "\"scenes\": [{\"nodes\": [0]}]");
  const AnimatedMesh node = ReadAnimation(folder_ / "node.gltf", 2);
  EXPECT_NEAR(node.key_frames[1][0].y, -4, 1e-6);  // half of 8 along z of the file
  EXPECT_NEAR(node.key_frames[1][1].y, -4, 1e-6);

  // Of the skin, the second joint moves, and only the second vertex half follows it.
  gltf.Write(folder_ / "skin.gltf",
             moves +
                 "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0,"
                 "\"JOINTS_0\": 4, \"WEIGHTS_0\": 5}, \"indices\": 1}]}],"
                 "\"skins\": [{\"joints\": [0, 1], \"inverseBindMatrices\": 6}],"
                 "\"nodes\": [{\"name\": \"a\"}, {\"name\": \"b\"}, {\"mesh\": 0, \"skin\": 0}],"
                 "\"scenes\": [{\"nodes\": [0, 1, 2]}]");
  const AnimatedMesh skin = ReadAnimation(folder_ / "skin.gltf", 2);
  EXPECT_NEAR(skin.key_frames[1][0].y, 0, 1e-6);
  EXPECT_NEAR(skin.key_frames[1][1].y, -2, 1e-6);
  EXPECT_NEAR(skin.key_frames[1][2].y, 0, 1e-6);
}

TEST_F(MeshIo, Faults) {
  EXPECT_NE(Complaint(folder_ / "none.obj").find("no such file"), std::string::npos);
  EXPECT_NE(Complaint(Write("mesh.txt", kBoxObj)).find("save it as .obj"), std::string::npos);
  EXPECT_NE(Complaint(Write("bad.ply", "ply\nformat nonsense\n")).find("cannot be read"),
            std::string::npos);
  EXPECT_NE(Complaint(Write("empty.obj", "")), "");
  EXPECT_NE(Complaint(Write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), "");
  EXPECT_NE(Complaint(Write("line.ply",
                            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                            "property float y\nproperty float z\nelement face 1\n"
                            "property list uchar int vertex_indices\nend_header\n"
                            "0 0 0\n0 0 0\n1 0 0\n3 0 1 2\n"))
                .find("no triangles"),
            std::string::npos);
  EXPECT_THROW(ReadAnimation(Write("still.obj", kBoxObj), 3), InputError);
}

TEST_F(MeshIo, RefusesWhatIsNoNumber) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  const float coordinates[9] = {0, 0, 0, 1, std::nanf(""), 0, 0, 1, 0};
  const std::int32_t corners[3] = {0, 1, 2};
  text.append(reinterpret_cast<const char*>(coordinates), sizeof coordinates);
  text += '\3';
  text.append(reinterpret_cast<const char*>(corners), sizeof corners);
  EXPECT_NE(Complaint(Write("nan.ply", text)).find("vertex 2 "), std::string::npos);
}

TEST_F(MeshIo, RefusesKeyFramesOfAnotherTopology) {
  const auto first = Write("0.ply", kTetrahedronPly);
  const std::string turned =
      std::string(kTetrahedronPly)
          .replace(std::string(kTetrahedronPly).find("3 1 2 3"), 7, "3 1 3 2");
  for (const auto& other : {Write("1.ply", turned), Write("2.obj", kBoxObj)}) {
    try {
      ReadKeyFrames({first, other});
      ADD_FAILURE() << other;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(other.string() + ": it has other triangles"),
                std::string::npos);
    }
  }
}

}  // namespace
}  // namespace flocklift
