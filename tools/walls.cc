// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/walls.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "simulate/core/check.h"
#include "simulate/core/text.h"

namespace flocklift {

void AddWallsFlag(CLI::App& command, std::string* text) {
  command.add_option("--walls", *text,
                     "X0,Y0,Z0,X1,Y1,Z1: the box that walls the flock in [m]; default: none");
}

std::optional<Region> ParseWalls(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::array<double, 6> numbers{};
  std::string_view rest = text;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const std::size_t comma = k + 1 < numbers.size() ? rest.find(',') : rest.size();
    const std::optional<double> number =
        comma == std::string_view::npos ? std::nullopt : ParseReal(rest.substr(0, comma));
    Check(number.has_value(), "--walls " + text + " is not X0,Y0,Z0,X1,Y1,Z1");
    numbers[k] = *number;
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  const Region walls{{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
  Check(walls.low.x < walls.high.x && walls.low.y < walls.high.y && walls.low.z < walls.high.z,
        "--walls " + text + ": the first corner must lie below the second on every axis");
  return walls;
}

}  // namespace flocklift
