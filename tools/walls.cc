// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/walls.h"

#include <string_view>

#include "simulate/core/check.h"
#include "simulate/core/text.h"

namespace flocklift {

void AddWallsFlag(CLI::App& command, std::string* text) {
  command.add_option("--walls", *text,
                     "X0,Y0,Z0,X1,Y1,Z1: the box that walls the flock in [m]; default: none");
}

std::optional<std::vector<double>> ParseNumbers(const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  std::string_view rest = text;
  for (;;) {
    const std::size_t comma = rest.find(',');
    const std::optional<double> number = ParseReal(rest.substr(0, comma));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

std::optional<Region> ParseWalls(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::optional<std::vector<double>> n = ParseNumbers(text, 6);
  Check(n.has_value(), "--walls " + text + " is not X0,Y0,Z0,X1,Y1,Z1");
  const Region walls{{(*n)[0], (*n)[1], (*n)[2]}, {(*n)[3], (*n)[4], (*n)[5]}};
  Check(walls.low.x < walls.high.x && walls.low.y < walls.high.y && walls.low.z < walls.high.z,
        "--walls " + text + ": the first corner must lie below the second on every axis");
  return walls;
}

void AddObstacleFlag(CLI::App& command, std::vector<std::string>* texts) {
  command
      .add_option(
          "--obstacle", *texts,
          "X,Y,Z,RADIUS or X0,Y0,Z0,X1,Y1,Z1 [m], or a mesh file: something solid in the way "
          "of models that avoid it (bswarm, shape, swarm); may be given again")
      ->allow_extra_args(false);
}

std::vector<ObstacleSpec> ParseObstacles(const std::vector<std::string>& texts) {
  std::vector<ObstacleSpec> obstacles;
  for (const std::string& text : texts) {
    ObstacleSpec obstacle;
    if (const auto ball = ParseNumbers(text, 4)) {
      Check((*ball)[3] > 0, "--obstacle " + text + ": the radius must be positive");
      obstacle.placement.position = {(*ball)[0], (*ball)[1], (*ball)[2]};
      obstacle.radius = (*ball)[3];
    } else if (const auto n = ParseNumbers(text, 6)) {
      obstacle.box = Region{{(*n)[0], (*n)[1], (*n)[2]}, {(*n)[3], (*n)[4], (*n)[5]}};
      Check((*n)[0] < (*n)[3] && (*n)[1] < (*n)[4] && (*n)[2] < (*n)[5],
            "--obstacle " + text + ": the first corner must lie below the second on every axis");
    } else {
      obstacle.mesh = text;
    }
    obstacles.push_back(obstacle);
  }
  return obstacles;
}

}  // namespace flocklift
