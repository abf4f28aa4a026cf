// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the surroundings do to an animal, for every motion: goals pull, predators frighten.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SURROUNDINGS_FORCES_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SURROUNDINGS_FORCES_H_

#include "simulate/flock/herd.h"
#include "simulate/flock/world.h"
#include "simulate/forces/attraction.h"
#include "simulate/forces/flee.h"

namespace flocklift {

inline constexpr double kFearTaper = 0.25;  // of the fear radius

// fn(goal) for each goal of this species.
template <typename T, typename Function>
void ForEachGoal(const Surroundings& around, const Herd<T>& herd, const Function& fn) {
  for (const GoalSpec& goal : around.goals) {
    if (goal.species.empty() || goal.species == herd.species) fn(goal);
  }
}

template <typename T>
bool HasGoal(const Surroundings& around, const Herd<T>& herd) {
  bool has = false;
  ForEachGoal(around, herd, [&has](const GoalSpec&) { has = true; });
  return has;
}

// The goals' springs, which give way beyond `range` [m].
template <typename T>
Vec3<T> GoalPull(const Surroundings& around, const Herd<T>& herd, T range, const Vec3<T>& x,
                 const Vec3<T>& v) {
  Vec3<T> sum{};
  ForEachGoal(around, herd, [&](const GoalSpec& goal) {
    const Attraction::Params<T> p{static_cast<T>(goal.weight), Cast<T>(goal.position), range};
    sum += Attraction::At(p, x, v);
  });
  return sum;
}

// Away from the predators.
template <typename T>
Vec3<T> Fear(const Surroundings& around, const Vec3<T>& x) {
  Vec3<T> sum{};
  for (const Predator& predator : around.predators) {
    const Flee::Params<T> p{static_cast<T>(predator.fear_weight),
                            static_cast<T>(predator.fear_radius),
                            static_cast<T>(kFearTaper * predator.fear_radius)};
    Weighted<T> push;
    push += Flee::Pair(p, Cast<T>(predator.position) - x, Vec3<T>{});
    sum += Flee::Finish(p, push);
  }
  return sum;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SURROUNDINGS_FORCES_H_
