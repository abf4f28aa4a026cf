// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Options are plain aggregates with their defaults in the header. One function per struct, found by
// argument-dependent lookup, names every field once:
//
//   template <typename Visitor>
//   void Describe(Visitor& visit, TrackerOptions& o) {
//     visit("gate-probability", o.gate_probability, {.low = 0.5, .high = 1}, "",
//           "chi-square mass inside the association gate");
//   }
//
// Command-line flags, range checks and the manifest in the summary all derive from it.

#ifndef FLOCKLIFT_SIMULATE_CORE_OPTIONS_H_
#define FLOCKLIFT_SIMULATE_CORE_OPTIONS_H_

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "simulate/core/check.h"

namespace flocklift {

// A field that is one of a few names.
struct Choice {
  std::span<const std::string_view> names;  // of static storage
  int index = 0;

  std::string_view name() const { return names[static_cast<std::size_t>(index)]; }
};

// Legal values of a number, both ends included.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

namespace internal {

struct RangeChecker {
  template <typename T>
  void operator()(std::string_view name, const T& value, Range range, std::string_view unit,
                  std::string_view /*help*/) {
    if constexpr (std::is_arithmetic_v<T>) {
      const double number = static_cast<double>(value);
      if (number >= range.low && number <= range.high) return;
      std::string message = "option ";
      message.append(name).append(" is ").append(std::to_string(value));
      message.append(", allowed are ").append(std::to_string(range.low));
      message.append(" to ").append(std::to_string(range.high));
      if (!unit.empty()) message.append(" ").append(unit);
      Check(false, message);
    }
  }
};

}  // namespace internal

// Throws std::invalid_argument that names the first field out of its range (NaN included).
template <typename Options>
void CheckOptions(const Options& options) {
  internal::RangeChecker checker;
  Options copy = options;
  Describe(checker, copy);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_OPTIONS_H_
