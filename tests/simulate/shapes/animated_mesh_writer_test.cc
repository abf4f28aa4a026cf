// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/animated_mesh_writer.h"

#include <assimp/anim.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "simulate/core/check.h"
#include "simulate/shapes/animated_mesh_frames.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr double kFps = 25;
const std::vector<std::array<std::uint32_t, 3>> kFaces{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

std::vector<std::vector<Vec3<float>>> Frames() {
  std::vector<std::vector<Vec3<float>>> frames;
  for (int f = 0; f < 5; ++f) {
    const auto s = static_cast<float>(f);
    frames.push_back({{s, 0, 0}, {1 + s, 0.5F * s, 0}, {0, 1 - s, 2}, {0.25F, 0, 3 + s * s}});
  }
  return frames;
}

fs::path Write(const std::string& name, bool quantize) {
  const fs::path path = fs::path(testing::TempDir()) / name;
  const auto frames = Frames();
  AnimatedMeshWriter writer(path, kFaces, 4,
                            {.fps = kFps, .most_frames = 5, .quantize = quantize, .extent = 25});
  for (const auto& frame : frames) writer.AddFrame(frame);
  writer.Finish();
  return path;
}

TEST(AnimatedMeshWriter, AssimpReadsBackEveryFrame) {
  const fs::path path = Write("frames.glb", false);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path.string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1u);
  const aiMesh& mesh = *scene->mMeshes[0];
  const auto frames = Frames();
  ASSERT_EQ(mesh.mNumVertices, 4u);
  EXPECT_EQ(mesh.mNumFaces, 4u);
  ASSERT_EQ(mesh.mNumAnimMeshes, 4u);
  const auto ours = [](const aiVector3D& p) { return Vec3<float>{p.x, -p.z, p.y}; };
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (unsigned v = 0; v < 4; ++v) {
      const aiVector3D& p = f == 0 ? mesh.mVertices[v] : mesh.mAnimMeshes[f - 1]->mVertices[v];
      EXPECT_LT(Norm(ours(p) - frames[f][v]), 1e-5F);
    }
  }
  ASSERT_EQ(scene->mNumAnimations, 1u);
  ASSERT_EQ(scene->mAnimations[0]->mNumMorphMeshChannels, 1u);
  const aiMeshMorphAnim& channel = *scene->mAnimations[0]->mMorphMeshChannels[0];
  ASSERT_EQ(channel.mNumKeys, 5u);
  for (unsigned k = 0; k < 5; ++k) {
    EXPECT_NEAR(channel.mKeys[k].mTime, 1000 * k / kFps, 1e-3);  // [ms]
    for (unsigned w = 0; w < channel.mKeys[k].mNumValuesAndWeights; ++w) {
      const bool shown = k > 0 && channel.mKeys[k].mValues[w] == k - 1;
      EXPECT_EQ(channel.mKeys[k].mWeights[w], shown ? 1 : 0);
    }
  }
}

struct Glb {
  nlohmann::json json;
  std::string data;
};
Glb Parse(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(8), bytes.size());
  const std::uint32_t json_length = word(12);
  EXPECT_EQ(json_length % 4, 0u);
  EXPECT_EQ(word(20 + json_length), bytes.size() - 28 - json_length);
  return {nlohmann::json::parse(bytes.substr(20, json_length)), bytes.substr(28 + json_length)};
}

TEST(AnimatedMeshWriter, QuantisedFramesAreGoodToTheExtentOver65000) {
  const Glb glb = Parse(Write("quantised.glb", true));
  const auto frames = Frames();
  const double extent = glb.json["nodes"][0]["scale"][0];
  EXPECT_EQ(extent, 25);
  const auto& targets = glb.json["meshes"][0]["primitives"][0]["targets"];
  ASSERT_EQ(targets.size(), 4u);
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const auto& accessor = glb.json["accessors"][targets[f - 1]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(accessor["componentType"], 5122);
    const std::size_t start =
        accessor["byteOffset"].get<std::size_t>() +
        glb.json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"]
            .get<std::size_t>();
    for (std::size_t v = 0; v < 4; ++v) {
      std::int16_t d[3];
      std::memcpy(d, glb.data.data() + start + 8 * v, 6);
      const Vec3d moved = extent / 32767 * Vec3d{d[0] * 1.0, -d[2] * 1.0, d[1] * 1.0};
      const Vec3<float> true_move = frames[f][v] - frames[0][v];
      EXPECT_NEAR(moved.x, true_move.x, extent / 65000);
      EXPECT_NEAR(moved.y, true_move.y, extent / 65000);
      EXPECT_NEAR(moved.z, true_move.z, extent / 65000);
      for (int c = 0; c < 3; ++c) {
        EXPECT_GE(d[c], accessor["min"][c].get<int>());
        EXPECT_LE(d[c], accessor["max"][c].get<int>());
      }
    }
  }
}

// A reader trusts offsets and lengths; none may point outside.
TEST(AnimatedMeshWriter, EveryAccessorLiesInTheData) {
  for (const bool quantize : {false, true}) {
    const Glb glb = Parse(Write("inside.glb", quantize));
    EXPECT_EQ(glb.json["buffers"][0]["byteLength"], glb.data.size());
    for (const auto& accessor : glb.json["accessors"]) {
      const auto& view = glb.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
      const std::size_t size =
          (accessor["type"] == "VEC3" ? 3 : 1) * (accessor["componentType"] == 5122 ? 2 : 4);
      const std::size_t stride = view.value("byteStride", size);
      EXPECT_LE(accessor.value("byteOffset", 0U) +
                    stride * (accessor["count"].get<std::size_t>() - 1) + size,
                view["byteLength"].get<std::size_t>());
      EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
                glb.data.size());
      EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
    }
  }
}

TEST(AnimatedMeshFrames, ReadsBackWhatWasWritten) {
  const auto frames = Frames();
  for (const bool quantize : {false, true}) {
    const AnimatedMeshFrames read(Write("read.glb", quantize));
    ASSERT_EQ(read.frame_count(), frames.size());
    ASSERT_EQ(read.vertex_count(), 4u);
    for (std::size_t f = frames.size(); f-- > 0;) {
      const std::vector<Vec3d> vertices = read.Frame(f);
      for (std::size_t v = 0; v < 4; ++v) {
        const Vec3<float>& p = frames[f][v];
        EXPECT_LT(Norm(vertices[v] - Vec3d{p.x, p.y, p.z}), quantize ? 2 * 25 / 65000.0 : 1e-5);
      }
    }
    EXPECT_THROW(read.Frame(frames.size()), std::invalid_argument);
  }
}

TEST(AnimatedMeshFrames, RefusesOtherFiles) {
  const fs::path path = fs::path(testing::TempDir()) / "text.glb";
  EXPECT_THROW(AnimatedMeshFrames{path / "missing"}, InputError);
  std::ofstream(path) << "not a mesh, but long enough for a header";
  EXPECT_THROW(AnimatedMeshFrames{path}, InputError);
}

TEST(AnimatedMeshWriter, OneFrameIsAMeshThatStands) {
  const fs::path path = fs::path(testing::TempDir()) / "one.glb";
  AnimatedMeshWriter writer(path, kFaces, 4, {.most_frames = 3, .quantize = false});
  writer.AddFrame(Frames()[0]);
  writer.Finish();
  EXPECT_FALSE(Parse(path).json.contains("animations"));
}

TEST(AnimatedMeshWriter, RefusesOtherVerticesAndFramesTooMany) {
  const fs::path path = fs::path(testing::TempDir()) / "never.glb";
  fs::remove(path);
  {
    AnimatedMeshWriter writer(path, kFaces, 4, {.most_frames = 1});
    EXPECT_THROW(writer.AddFrame(std::vector<Vec3<float>>(3)), std::invalid_argument);
    writer.AddFrame(Frames()[0]);
    EXPECT_THROW(writer.AddFrame(Frames()[0]), std::invalid_argument);
  }
  EXPECT_FALSE(fs::exists(path));  // nobody called Finish
  EXPECT_THROW(AnimatedMeshWriter(path, kFaces, 1 << 22, {.most_frames = 1000}),
               std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
