// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/mesh_io.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <string>

#include "simulate/core/check.h"
#include "simulate/core/input_file.h"
#include "simulate/shapes/assimp_pose.h"
#include "simulate/shapes/weld.h"

namespace flocklift {
namespace {

std::string Extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

bool IsGltf(const std::filesystem::path& path) {
  return Extension(path) == ".gltf" || Extension(path) == ".glb";
}

// One line of what a library says.
std::string OneLine(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == ';') c = ' ';
  }
  return text.substr(0, 200);
}

const aiScene& Import(const std::filesystem::path& path, Assimp::Importer* importer) {
  OpenInput(path);
  const std::string extension = Extension(path);
  if (extension != ".obj" && extension != ".ply" && extension != ".stl" && !IsGltf(path)) {
    throw InputError(path.string(), 0, "not a mesh format that is read here",
                     "save it as .obj, .ply, .stl, .gltf or .glb");
  }
  // Vertices in the file's order and number: key-frames must stay comparable.
  const aiScene* scene =
      importer->ReadFile(path.string(), aiProcess_ValidateDataStructure | aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw InputError(path.string(), 0,
                     "cannot be read as a mesh (" + OneLine(importer->GetErrorString()) + ")",
                     "save it again, as triangles");
  }
  return *scene;
}

internal::Soup CheckedSoup(const std::filesystem::path& path, const aiScene& scene,
                           const aiAnimation* animation, double time) {
  internal::Soup soup = internal::PosedSoup(scene, animation, time);
  for (std::size_t v = 0; v < soup.vertices.size(); ++v) {
    Vec3d& p = soup.vertices[v];
    if (!std::isfinite(p.x + p.y + p.z)) {
      throw InputError(path.string(), 0,
                       "vertex " + std::to_string(v + 1) + " has a coordinate that is no number",
                       "repair the mesh");
    }
    if (IsGltf(path)) p = {p.x, -p.z, p.y};
  }
  for (const auto& triangle : soup.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= soup.vertices.size()) {
        throw InputError(path.string(), 0, "a triangle names a vertex that is not there",
                         "save the mesh again");
      }
    }
  }
  return soup;
}

AnimatedMesh Welded(const std::filesystem::path& path, const std::vector<internal::Soup>& frames) {
  AnimatedMesh mesh = internal::Weld(frames);
  if (mesh.triangles.empty()) {
    throw InputError(path.string(), 0, "it holds no triangles", "save the mesh with its faces");
  }
  return mesh;
}

}  // namespace

TriangleMesh ReadMesh(const std::filesystem::path& path) { return ReadKeyFrames({path}).Frame(0); }

AnimatedMesh ReadKeyFrames(const std::vector<std::filesystem::path>& paths) {
  Check(!paths.empty(), "an animation needs at least one key-frame");
  std::vector<internal::Soup> frames;
  for (const std::filesystem::path& path : paths) {
    Assimp::Importer importer;
    frames.push_back(CheckedSoup(path, Import(path, &importer), nullptr, 0));
    if (frames.back().vertices.size() != frames.front().vertices.size() ||
        frames.back().triangles != frames.front().triangles) {
      throw InputError(path.string(), 0, "it has other triangles than " + paths.front().string(),
                       "export all key-frames from one mesh, with the order of vertices kept");
    }
  }
  return Welded(paths.front(), frames);
}

AnimatedMesh ReadAnimation(const std::filesystem::path& path, int frame_count) {
  Check(frame_count >= 1, "an animation needs at least one key-frame");
  Assimp::Importer importer;
  const aiScene& scene = Import(path, &importer);
  if (scene.mNumAnimations == 0) {
    throw InputError(path.string(), 0, "it holds no animation",
                     "save it with one, or give its key-frames as files");
  }
  const aiAnimation& animation = *scene.mAnimations[0];
  std::vector<internal::Soup> frames;
  for (int k = 0; k < frame_count; ++k) {
    frames.push_back(CheckedSoup(path, scene, &animation, animation.mDuration * k / frame_count));
  }
  return Welded(path, frames);
}

}  // namespace flocklift
