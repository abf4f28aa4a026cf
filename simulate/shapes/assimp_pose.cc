// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/assimp_pose.h"

#include <assimp/anim.h>
#include <assimp/mesh.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace flocklift::internal {
namespace {

// The two keys about `time` and the share of the second; the ends hold beyond the ends.
template <typename Key>
struct Bracket {
  const Key *before, *after;
  double share;

  Bracket(const Key* keys, unsigned count, double time) {
    const Key* next = std::upper_bound(keys, keys + count, time,
                                       [](double t, const Key& key) { return t < key.mTime; });
    after = next == keys + count ? next - 1 : next;
    before = next == keys ? next : next - 1;
    const double gap = after->mTime - before->mTime;
    share = gap > 0 ? (time - before->mTime) / gap : 0;
  }
};

aiVector3D VectorAt(const aiVectorKey* keys, unsigned count, double time, const aiVector3D& none) {
  if (count == 0) return none;
  const Bracket<aiVectorKey> b(keys, count, time);
  return b.before->mValue + (b.after->mValue - b.before->mValue) * static_cast<ai_real>(b.share);
}

aiQuaternion RotationAt(const aiQuatKey* keys, unsigned count, double time) {
  if (count == 0) return {};
  const Bracket<aiQuatKey> b(keys, count, time);
  aiQuaternion rotation;
  aiQuaternion::Interpolate(rotation, b.before->mValue, b.after->mValue,
                            static_cast<ai_real>(b.share));
  return rotation.Normalize();
}

class Poser {
 public:
  Poser(const aiScene& scene, const aiAnimation* animation, double time)
      : scene_(scene), animation_(animation), time_(time) {
    Place(scene.mRootNode, aiMatrix4x4());
    Collect(scene.mRootNode);
  }
  Soup&& Take() { return std::move(soup_); }

 private:
  void Place(const aiNode* node, const aiMatrix4x4& scene_from_parent) {
    const aiMatrix4x4 scene_from_node = scene_from_parent * LocalTransform(*node);
    scene_from_node_[node] = scene_from_node;
    node_of_name_.emplace(node->mName.C_Str(), node);
    for (unsigned k = 0; k < node->mNumChildren; ++k) Place(node->mChildren[k], scene_from_node);
  }

  aiMatrix4x4 LocalTransform(const aiNode& node) const {
    for (unsigned k = 0; animation_ != nullptr && k < animation_->mNumChannels; ++k) {
      const aiNodeAnim& moving = *animation_->mChannels[k];
      if (moving.mNodeName != node.mName) continue;
      return {VectorAt(moving.mScalingKeys, moving.mNumScalingKeys, time_, {1, 1, 1}),
              RotationAt(moving.mRotationKeys, moving.mNumRotationKeys, time_),
              VectorAt(moving.mPositionKeys, moving.mNumPositionKeys, time_, {})};
    }
    return node.mTransformation;
  }

  void Collect(const aiNode* node) {
    for (unsigned k = 0; k < node->mNumMeshes; ++k) Add(*scene_.mMeshes[node->mMeshes[k]], *node);
    for (unsigned k = 0; k < node->mNumChildren; ++k) Collect(node->mChildren[k]);
  }

  void Add(const aiMesh& mesh, const aiNode& node) {
    std::vector<aiVector3D> points(mesh.mVertices, mesh.mVertices + mesh.mNumVertices);
    Morph(mesh, node, &points);
    ToScene(mesh, scene_from_node_.at(&node), &points);
    const auto first = static_cast<std::uint32_t>(soup_.vertices.size());
    for (const aiVector3D& p : points) soup_.vertices.push_back({p.x, p.y, p.z});
    // A mirroring transform turns triangles inside out; turn them back.
    const bool mirrored = mesh.mNumBones == 0 && scene_from_node_.at(&node).Determinant() < 0;
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices != 3) continue;
      std::uint32_t b = first + face.mIndices[1], c = first + face.mIndices[2];
      if (mirrored) std::swap(b, c);
      soup_.triangles.push_back({first + face.mIndices[0], b, c});
    }
  }

  void Morph(const aiMesh& mesh, const aiNode& node, std::vector<aiVector3D>* points) const {
    for (unsigned k = 0; animation_ != nullptr && k < animation_->mNumMorphMeshChannels; ++k) {
      const aiMeshMorphAnim& channel = *animation_->mMorphMeshChannels[k];
      if (channel.mName != node.mName || channel.mNumKeys == 0) continue;
      const Bracket<aiMeshMorphKey> b(channel.mKeys, channel.mNumKeys, time_);
      Blend(mesh, *b.before, 1 - b.share, points);
      Blend(mesh, *b.after, b.share, points);
    }
  }
  static void Blend(const aiMesh& mesh, const aiMeshMorphKey& key, double share,
                    std::vector<aiVector3D>* points) {
    for (unsigned m = 0; m < key.mNumValuesAndWeights; ++m) {
      if (key.mValues[m] >= mesh.mNumAnimMeshes) continue;
      const aiAnimMesh& target = *mesh.mAnimMeshes[key.mValues[m]];
      if (target.mVertices == nullptr || target.mNumVertices != mesh.mNumVertices) continue;
      const auto weight = static_cast<ai_real>(share * key.mWeights[m]);
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        (*points)[v] += (target.mVertices[v] - mesh.mVertices[v]) * weight;
      }
    }
  }

  void ToScene(const aiMesh& mesh, const aiMatrix4x4& scene_from_node,
               std::vector<aiVector3D>* points) const {
    std::vector<aiVector3D> skinned(points->size());
    std::vector<ai_real> weight_sum(points->size(), 0);
    for (unsigned k = 0; k < mesh.mNumBones; ++k) {
      const aiBone& bone = *mesh.mBones[k];
      const auto found = node_of_name_.find(bone.mName.C_Str());
      if (found == node_of_name_.end()) continue;
      const aiMatrix4x4 scene_from_mesh = scene_from_node_.at(found->second) * bone.mOffsetMatrix;
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        const auto [vertex, weight] =
            std::pair(bone.mWeights[w].mVertexId, bone.mWeights[w].mWeight);
        if (vertex >= points->size()) continue;
        skinned[vertex] += (scene_from_mesh * (*points)[vertex]) * weight;
        weight_sum[vertex] += weight;
      }
    }
    for (std::size_t v = 0; v < points->size(); ++v) {
      (*points)[v] =
          weight_sum[v] > 0 ? skinned[v] / weight_sum[v] : scene_from_node * (*points)[v];
    }
  }

  const aiScene& scene_;
  const aiAnimation* animation_;
  double time_;
  std::map<const aiNode*, aiMatrix4x4> scene_from_node_;
  std::map<std::string, const aiNode*> node_of_name_;
  Soup soup_;
};

}  // namespace

Soup PosedSoup(const aiScene& scene, const aiAnimation* animation, double time) {
  return Poser(scene, animation, time).Take();
}

}  // namespace flocklift::internal
