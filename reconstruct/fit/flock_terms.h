// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A model's right-hand side, taken apart into what is linear in its weights:
//   a_i = sum_p theta_p f_p(i) + known(i) + c_i g(i)
// f_p is the term of weight p with weight 1, `known` the terms whose weights are given, and c_i an
// unknown of each animal: cruise times its own cruising speed less `cruising_speed`, g = v/|v|. All
// by the same templated terms that the simulator runs. A point that attracts (a scene's [[goal]])
// is one more term, whose weight has the name kGoalWeight. So are the force terms that a scene adds
// (scene_terms.h); of the model `forces` they are all.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_FLOCK_TERMS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_FLOCK_TERMS_H_

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reconstruct/fit/term_surroundings.h"
#include "simulate/core/scene.h"

namespace flocklift {

struct FlockTerms {
  std::vector<std::string> free;  // the p weights, by their names in the model
  bool has_own_speed = false;     // is there a c_i?
  double min_speed = 0;           // of the model's clamp [m/s]
  double max_speed = std::numeric_limits<double>::infinity();
  // Fills `out`, n x (p + 2): f_1 .. f_p, known, g; accelerations [m/s^2] of the animals at
  // positions x with velocities v. Safe to call from several threads.
  std::function<void(std::span<const Vec3d> x, std::span<const Vec3d> v, std::span<Vec3d> out)>
      evaluate;

  std::size_t columns() const { return free.size() + 2; }
};

inline constexpr const char* kGoalWeight = "goal";  // [1/s^2]

// The weights of a model, and of its terms, that FitModel can free. Empty for a model that moves
// positions directly.
std::vector<std::string> LinearWeights(const ModelSpec& model);

// `model` gives every value that is not free, `walls` the box of the boundary term (without it the
// term is left out, and so must be its weight), `goal` the point that attracts, at rest, if any,
// `cruising_speed` what the cruise term takes all animals' own speeds for [m/s], `around` what the
// terms of a scene feel. Throws InputError for a name that is no weight of the model.
FlockTerms MakeFlockTerms(const ModelSpec& model, const std::vector<std::string>& free,
                          const std::optional<Region>& walls,
                          const std::optional<GoalSpec>& goal = {}, double cruising_speed = 0,
                          const TermSurroundings& around = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_FLOCK_TERMS_H_
