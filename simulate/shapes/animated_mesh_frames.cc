// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/animated_mesh_frames.h"

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr std::uint64_t kHeaderBytes = 12, kChunkBytes = 8;
constexpr double kShortScale = 32767;

[[noreturn]] void Fail(const std::filesystem::path& path, const std::string& fault) {
  throw InputError(path.string(), 0, fault, "give a GLB file that simulate wrote");
}

}  // namespace

AnimatedMeshFrames::AnimatedMeshFrames(const std::filesystem::path& path) : path_(path) {
  const std::string header = Bytes(0, kHeaderBytes + kChunkBytes);
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, header.data() + kHeaderBytes, sizeof json_bytes);
  if (header.compare(0, 4, "glTF") != 0) Fail(path, "this is no GLB file");
  const std::uint64_t data = kHeaderBytes + kChunkBytes + json_bytes + kChunkBytes;
  try {
    const auto json = nlohmann::json::parse(Bytes(kHeaderBytes + kChunkBytes, json_bytes));
    const auto& node = json.at("nodes").at(0);
    if (node.contains("scale")) scale_ = node.at("scale").at(0);
    const auto& primitive = json.at("meshes").at(0).at("primitives").at(0);
    const auto offset_of = [&](const nlohmann::json& accessor) {
      const auto& view = json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
      return data + view.at("byteOffset").get<std::uint64_t>() +
             accessor.value("byteOffset", std::uint64_t{0});
    };
    const auto accessor = [&](const nlohmann::json& index) -> const nlohmann::json& {
      return json.at("accessors").at(index.get<std::size_t>());
    };
    const auto& base = accessor(primitive.at("attributes").at("POSITION"));
    const auto count = base.at("count").get<std::size_t>();
    std::vector<float> numbers(3 * count);
    std::memcpy(numbers.data(), Bytes(offset_of(base), 12 * count).data(), 12 * count);
    for (std::size_t v = 0; v < count; ++v) {
      base_.push_back({numbers[3 * v], numbers[3 * v + 1], numbers[3 * v + 2]});
    }
    if (!primitive.contains("targets")) return;
    for (const auto& target : primitive.at("targets")) {
      const auto& displacement = accessor(target.at("POSITION"));
      quantized_ = displacement.value("normalized", false);
      offsets_.push_back(offset_of(displacement));
    }
  } catch (const nlohmann::json::exception&) {
    Fail(path, "this GLB file holds no animated mesh");
  }
}

std::string AnimatedMeshFrames::Bytes(std::uint64_t offset, std::uint64_t count) const {
  std::ifstream stream(path_, std::ios::binary);
  if (!stream) Fail(path_, "cannot be read");
  std::string bytes(count, '\0');
  stream.seekg(static_cast<std::streamoff>(offset));
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  if (static_cast<std::uint64_t>(stream.gcount()) != count) Fail(path_, "the file ends early");
  return bytes;
}

std::vector<Vec3d> AnimatedMeshFrames::Frame(std::size_t k) const {
  Check(k < frame_count(), "there is no such frame");
  std::vector<Vec3d> vertices = base_;
  if (k > 0) {
    const std::size_t stride = quantized_ ? 8 : 12;
    const std::string bytes = Bytes(offsets_[k - 1], stride * vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (quantized_) {
        std::int16_t d[3];
        std::memcpy(d, bytes.data() + stride * v, sizeof d);
        vertices[v] += Vec3d{d[0] / kShortScale, d[1] / kShortScale, d[2] / kShortScale};
      } else {
        float d[3];
        std::memcpy(d, bytes.data() + stride * v, sizeof d);
        vertices[v] += Vec3d{d[0], d[1], d[2]};
      }
    }
  }
  for (Vec3d& p : vertices) p = scale_ * Vec3d{p.x, -p.z, p.y};  // glTF has y up
  return vertices;
}

}  // namespace flocklift
