// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Flags of fit and replay that are places: --walls X0,Y0,Z0,X1,Y1,Z1, the box of a model's boundary
// term [m]; --obstacle, something solid besides.

#ifndef FLOCKLIFT_TOOLS_WALLS_H_
#define FLOCKLIFT_TOOLS_WALLS_H_

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "simulate/core/scene.h"

namespace flocklift {

void AddWallsFlag(CLI::App& command, std::string* text);

// "A,B,C": exactly `count` numbers, or nothing.
std::optional<std::vector<double>> ParseNumbers(const std::string& text, std::size_t count);

// Nothing for an empty text. Throws std::invalid_argument when it is no box.
std::optional<Region> ParseWalls(const std::string& text);

void AddObstacleFlag(CLI::App& command, std::vector<std::string>* texts);

// "X,Y,Z,RADIUS" is a ball, "X0,Y0,Z0,X1,Y1,Z1" a box [m], all else a mesh file. Throws
// std::invalid_argument for a ball or box without inside.
std::vector<ObstacleSpec> ParseObstacles(const std::vector<std::string>& texts);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_WALLS_H_
