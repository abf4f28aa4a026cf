// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A glTF file of one triangle, put together by hand, its buffer beside it.

#ifndef FLOCKLIFT_TESTS_SIMULATE_SHAPES_SMALL_GLTF_H_
#define FLOCKLIFT_TESTS_SIMULATE_SHAPES_SMALL_GLTF_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "simulate/core/atomic_file.h"

namespace flocklift {

// Accessors are numbered in the order of the calls.
class SmallGltf {
 public:
  void Floats(const std::vector<float>& values, const std::string& type) {
    const std::size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
    std::string extra;
    if (type == "VEC3" || type == "SCALAR") extra = Extremes(values, width);
    Add(values.data(), 4 * values.size(), values.size() / width, 5126, type, extra);
  }
  void Shorts(const std::vector<std::uint16_t>& values, const std::string& type) {
    const std::size_t width = type == "SCALAR" ? 1 : 4;
    Add(values.data(), 2 * values.size(), values.size() / width, 5123, type, "");
  }

  // `rest`: the members "meshes", "nodes", and so on, without braces.
  void Write(const std::filesystem::path& path, const std::string& rest) const {
    std::filesystem::path buffer = path;
    buffer.replace_extension(".bin");
    WriteTextFile(buffer, bytes_);
    WriteTextFile(path,
                  "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0,\n\"buffers\": [{\"uri\": \"" +
                      buffer.filename().string() + "\", \"byteLength\": " +
                      std::to_string(bytes_.size()) + "}],\n\"bufferViews\": [" + views_ +
                      "],\n\"accessors\": [" + accessors_ + "],\n" + rest + "}\n");
  }

 private:
  static std::string Extremes(const std::vector<float>& values, std::size_t width) {
    std::string low, high;
    for (std::size_t k = 0; k < width; ++k) {
      float least = values[k], most = values[k];
      for (std::size_t v = k; v < values.size(); v += width) {
        least = std::min(least, values[v]);
        most = std::max(most, values[v]);
      }
      low += (k > 0 ? "," : "") + std::to_string(least);
      high += (k > 0 ? "," : "") + std::to_string(most);
    }
    return ", \"min\": [" + low + "], \"max\": [" + high + "]";
  }
  void Add(const void* data, std::size_t bytes, std::size_t count, int component,
           const std::string& type, const std::string& extra) {
    const std::string separator = views_.empty() ? "" : ", ";
    views_ += separator + "{\"buffer\": 0, \"byteOffset\": " + std::to_string(bytes_.size()) +
              ", \"byteLength\": " + std::to_string(bytes) + "}";
    accessors_ += separator + "{\"bufferView\": " + std::to_string(views_number_++) +
                  ", \"componentType\": " + std::to_string(component) +
                  ", \"count\": " + std::to_string(count) + ", \"type\": \"" + type + "\"" + extra +
                  "}";
    bytes_.append(static_cast<const char*>(data), bytes);
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
  }

  std::string bytes_, views_, accessors_;
  int views_number_ = 0;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_SHAPES_SMALL_GLTF_H_
