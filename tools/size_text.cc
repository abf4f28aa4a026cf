// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/size_text.h"

#include <CLI/CLI.hpp>
#include <array>
#include <optional>

#include "simulate/core/text.h"

namespace flocklift {

std::pair<int, int> ParseSize(const std::string& text, const std::string& flag) {
  constexpr std::int64_t kLargest = 1000000;
  const auto cross = text.find_first_of("xX");
  if (cross != std::string::npos) {
    const auto width = ParseInteger(Trim(text.substr(0, cross)));
    const auto height = ParseInteger(Trim(text.substr(cross + 1)));
    if (width && height && *width > 0 && *height > 0 && *width <= kLargest && *height <= kLargest) {
      return {static_cast<int>(*width), static_cast<int>(*height)};
    }
  }
  throw CLI::ValidationError(flag, Quoted(text) + " is no size; write two numbers as in 1920x1080");
}

Vec3d ParsePoint(const std::string& text, const std::string& flag) {
  std::array<double, 3> point{};
  std::size_t begin = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto comma = text.find(',', begin);
    const auto value = ParseReal(Trim(text.substr(begin, comma - begin)));
    if (!value || (comma == std::string::npos) != (k == 2)) {
      throw CLI::ValidationError(
          flag, Quoted(text) + " is no point; write three numbers as in 0,-45,1.7");
    }
    point[k] = *value;
    begin = comma + 1;
  }
  return {point[0], point[1], point[2]};
}

}  // namespace flocklift
