// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A number for a problem, with all that its solution depends on: another problem has the same one
// with a chance of 1 in 2^64.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_FINGERPRINT_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_FINGERPRINT_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "reconstruct/initialize/segments.h"
#include "reconstruct/knowledge.h"
#include "reconstruct/solve/batch_options.h"
#include "simulate/core/options.h"

namespace flocklift::internal {

// FNV-1a, 64 bit (Fowler, Noll and Vo, 1991).
class Hash {
 public:
  void AddBytes(const void* bytes, std::size_t size) {
    const auto* at = static_cast<const unsigned char*>(bytes);
    for (std::size_t k = 0; k < size; ++k) value_ = (value_ ^ at[k]) * 0x100000001b3;
  }
  void Add(std::string_view text) { AddBytes(text.data(), text.size()); }
  template <typename T>
  void Add(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    AddBytes(&value, sizeof value);
  }
  void Add(const Vec2d& v) {
    for (const double x : {v.x, v.y}) Add(x);
  }
  void Add(const Vec3d& v) {
    for (const double x : {v.x, v.y, v.z}) Add(x);
  }
  void Add(const Uncertain& u) {
    Add(u.mean);
    Add(u.sd);
  }
  template <typename T>
  void Add(const std::optional<T>& value) {
    Add(value.has_value());
    if (value) Add(*value);
  }
  // As a visitor of Describe.
  template <typename T>
  void operator()(std::string_view /*name*/, const T& value, Range /*range*/,
                  std::string_view /*unit*/, std::string_view /*help*/) {
    Add(value);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

// `method`: of what goes on from the batch method's solution, with its options; 0: nothing does.
std::uint64_t FingerprintOf(const BatchOptions& options, const Knowledge& knowledge,
                            const Segments& segments, double fps, std::uint64_t method = 0);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_FINGERPRINT_H_
