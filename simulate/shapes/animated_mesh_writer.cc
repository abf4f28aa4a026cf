// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/animated_mesh_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr std::uint64_t kJsonRoom = 4096, kJsonRoomAFrame = 320;  // [bytes]
constexpr std::uint64_t kMostBytes = 0xFFFFFFFFU;
constexpr std::uint64_t kHeaderBytes = 12, kChunkBytes = 8;
constexpr int kFloat = 5126, kShort = 5122, kUnsignedInt = 5125;  // component types of glTF
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr float kShortScale = 32767;

Vec3<float> ToGltf(const Vec3<float>& p) { return {p.x, p.z, -p.y}; }

float TimeOf(std::size_t frame, double fps) {
  return static_cast<float>(static_cast<double>(frame) / fps);
}

std::uint64_t Padded(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }

nlohmann::json Numbers(const Vec3<float>& v, bool whole) {
  if (!whole) return {v.x, v.y, v.z};
  return {static_cast<int>(v.x), static_cast<int>(v.y), static_cast<int>(v.z)};
}

}  // namespace

AnimatedMeshWriter::AnimatedMeshWriter(const std::filesystem::path& path,
                                       std::span<const std::array<std::uint32_t, 3>> triangles,
                                       std::size_t vertex_count, const AnimatedMeshOptions& options)
    : options_(options),
      vertex_count_(vertex_count),
      index_count_(3 * triangles.size()),
      file_(path),
      stream_(file_.temporary(), std::ios::binary) {
  Check(options.fps > 0 && options.extent > 0, "frame rate and extent must be positive");
  Check(options.most_frames > 0 && vertex_count > 0, "an animated mesh needs frames and vertices");
  const auto frames = static_cast<std::uint64_t>(options.most_frames);
  json_room_ = Padded(kJsonRoom + kJsonRoomAFrame * frames);
  data_start_ = kHeaderBytes + kChunkBytes + json_room_ + kChunkBytes;
  const std::uint64_t a_frame = vertex_count * (options.quantize ? 8 : 12);
  Check(data_start_ + 4 * index_count_ + 12 * vertex_count + a_frame * frames +
                4 * frames * (frames + 1) <
            kMostBytes,
        "so many frames of so many vertices do not fit into a GLB file: fewer frames, or quantise");
  if (!stream_) throw std::runtime_error(path.string() + ": cannot be written");
  const std::vector<char> room(data_start_, ' ');
  Put(room.data(), room.size());
  for (const auto& triangle : triangles) Put(triangle.data(), 3);
}

template <typename Number>
void AnimatedMeshWriter::Put(const Number* numbers, std::size_t count) {
  stream_.write(reinterpret_cast<const char*>(numbers),
                static_cast<std::streamsize>(count * sizeof(Number)));
}

void AnimatedMeshWriter::AddFrame(std::span<const Vec3<float>> vertices) {
  Check(vertices.size() == vertex_count_, "all frames have the same vertices");
  Check(least_.size() < static_cast<std::size_t>(options_.most_frames), "a frame too many");
  const bool first = base_.empty(), quantize = options_.quantize && !first;
  // In the quantised file the node's scale is the extent, for the base as well.
  const float unit = options_.quantize ? 1 / static_cast<float>(options_.extent) : 1.0F;
  if (first) {
    base_offset_ = 4 * index_count_;
    targets_offset_ = base_offset_ + 12 * vertex_count_;
    base_.resize(vertex_count_);
  }
  buffer_.resize(vertex_count_ * (quantize ? 8 : 12));
  auto* const floats = reinterpret_cast<float*>(buffer_.data());
  auto* const shorts = reinterpret_cast<std::int16_t*>(buffer_.data());
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Vec3<float> least{kFar, kFar, kFar}, most{-kFar, -kFar, -kFar};
  for (std::size_t k = 0; k < vertex_count_; ++k) {
    Vec3<float> p = ToGltf(vertices[k]) * unit;
    if (first) {
      base_[k] = p;
    } else {
      p -= base_[k];
    }
    if (quantize) {
      const auto round = [](float x) {
        return std::nearbyint(std::clamp(x, -1.0F, 1.0F) * kShortScale);
      };
      p = {round(p.x), round(p.y), round(p.z)};
      shorts[4 * k] = static_cast<std::int16_t>(p.x);
      shorts[4 * k + 1] = static_cast<std::int16_t>(p.y);
      shorts[4 * k + 2] = static_cast<std::int16_t>(p.z);
      shorts[4 * k + 3] = 0;
    } else {
      floats[3 * k] = p.x;
      floats[3 * k + 1] = p.y;
      floats[3 * k + 2] = p.z;
    }
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  least_.push_back(least);
  most_.push_back(most);
  Put(buffer_.data(), buffer_.size());
}

std::string AnimatedMeshWriter::Description() const {
  const std::size_t frames = least_.size(), targets = frames - 1;
  const std::uint64_t a_target = vertex_count_ * (options_.quantize ? 8 : 12);
  const std::uint64_t times_offset = targets_offset_ + targets * a_target;
  const std::uint64_t weights_offset = times_offset + 4 * frames;
  const std::uint64_t bytes = weights_offset + 4 * frames * targets;

  using Json = nlohmann::ordered_json;
  const auto list = [](Json element) { return Json::array({std::move(element)}); };
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "flocklift"}};
  if (options_.quantize) {
    json["extensionsUsed"] = list("KHR_mesh_quantization");
    json["extensionsRequired"] = list("KHR_mesh_quantization");
  }
  json["scene"] = 0;
  json["scenes"] = list(Json{{"nodes", list(0)}});
  Json node{{"name", "flock"}, {"mesh", 0}};
  if (options_.quantize) node["scale"] = {options_.extent, options_.extent, options_.extent};
  json["nodes"] = list(node);
  const auto& [red, green, blue] = options_.colour;
  const Json surface{
      {"baseColorFactor", {red, green, blue, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.7}};
  json["materials"] = list(Json{{"pbrMetallicRoughness", surface}});
  json["buffers"] = list(Json{{"byteLength", bytes}});

  auto& views = json["bufferViews"];
  auto& accessors = json["accessors"];
  const auto view = [&](std::uint64_t offset, std::uint64_t length) -> Json& {
    views.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}});
    return views.back();
  };
  view(0, base_offset_)["target"] = kElementArrayBuffer;
  accessors.push_back({{"bufferView", 0},
                       {"componentType", kUnsignedInt},
                       {"count", index_count_},
                       {"type", "SCALAR"}});
  view(base_offset_, targets_offset_ - base_offset_)["target"] = kArrayBuffer;
  accessors.push_back({{"bufferView", 1},
                       {"componentType", kFloat},
                       {"count", vertex_count_},
                       {"type", "VEC3"},
                       {"min", Numbers(least_[0], false)},
                       {"max", Numbers(most_[0], false)}});
  Json primitive{{"attributes", Json{{"POSITION", 1}}}, {"indices", 0}, {"material", 0}};
  if (targets > 0) {
    auto& displacements = view(targets_offset_, targets * a_target);
    displacements["target"] = kArrayBuffer;
    if (options_.quantize) displacements["byteStride"] = 8;
    view(times_offset, 4 * frames);
    view(weights_offset, 4 * frames * targets);
    accessors.push_back({{"bufferView", 3},
                         {"componentType", kFloat},
                         {"count", frames},
                         {"type", "SCALAR"},
                         {"min", list(0)},
                         {"max", list(TimeOf(targets, options_.fps))}});
    accessors.push_back({{"bufferView", 4},
                         {"componentType", kFloat},
                         {"count", frames * targets},
                         {"type", "SCALAR"}});
    for (std::size_t k = 1; k < frames; ++k) {
      Json accessor{{"bufferView", 2},
                    {"byteOffset", (k - 1) * a_target},
                    {"componentType", options_.quantize ? kShort : kFloat}};
      if (options_.quantize) accessor["normalized"] = true;
      accessor["count"] = vertex_count_;
      accessor["type"] = "VEC3";
      accessor["min"] = Numbers(least_[k], options_.quantize);
      accessor["max"] = Numbers(most_[k], options_.quantize);
      primitive["targets"].push_back(Json{{"POSITION", accessors.size()}});
      accessors.push_back(std::move(accessor));
    }
    const Json channel{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}};
    const Json sampler{{"input", 2}, {"output", 3}, {"interpolation", "LINEAR"}};
    json["animations"] =
        list(Json{{"name", "flight"}, {"samplers", list(sampler)}, {"channels", list(channel)}});
  }
  json["meshes"] = list(Json{{"name", "flock"}, {"primitives", list(primitive)}});
  return json.dump();
}

void AnimatedMeshWriter::Finish() {
  Check(!least_.empty(), "an animated mesh needs a frame");
  const std::size_t frames = least_.size();
  for (std::size_t k = 0; k < frames; ++k) {
    const float time = TimeOf(k, options_.fps);
    Put(&time, 1);
  }
  for (std::size_t k = 0; k < frames; ++k) {
    std::vector<float> weights(frames - 1, 0.0F);
    if (k > 0) weights[k - 1] = 1;
    Put(weights.data(), weights.size());
  }
  const auto end = static_cast<std::uint64_t>(stream_.tellp());
  const std::string json = Description();
  if (json.size() > json_room_) throw std::logic_error("too little room for the JSON chunk");
  const auto word = [&](std::uint64_t value) {
    const auto small = static_cast<std::uint32_t>(value);
    Put(&small, 1);
  };
  stream_.seekp(0);
  Put("glTF", 4);
  word(2);
  word(end);
  word(json_room_);
  Put("JSON", 4);
  Put(json.data(), json.size());
  stream_.seekp(static_cast<std::streamoff>(data_start_ - kChunkBytes));
  word(end - data_start_);
  Put("BIN\0", 4);
  stream_.close();
  if (!stream_) throw std::runtime_error("the animated mesh cannot be written (disk full?)");
  file_.Commit();
}

}  // namespace flocklift
