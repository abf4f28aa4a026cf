// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What surrounds a flock whose force terms are to be evaluated, at rest. World frame, z up.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_TERM_SURROUNDINGS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_TERM_SURROUNDINGS_H_

#include <optional>
#include <vector>

#include "simulate/core/scene.h"

namespace flocklift {

struct TermSurroundings {
  std::optional<Region> walls = {};  // that `walls` pushes from; without them it does nothing
  std::vector<GoalSpec> goals = {};  // at rest
  Vec3d wind = {};                   // steady [m/s]
  bool flat = false;                 // z stays 0
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_TERM_SURROUNDINGS_H_
