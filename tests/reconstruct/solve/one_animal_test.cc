// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/one_animal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reconstruct/solve/depth_moves.h"
#include "reconstruct/solve/force_search.h"
#include "tests/reconstruct/coupled_case.h"

namespace flocklift {
namespace {

using internal::Bird;
using internal::CoupledFlock;
using internal::OneAnimal;
using internal::WindowToRefine;

// All hear each other, some of them on a rule's edge.
void HearAll(CoupledFlock* flock) {
  flock->noise = {.sd = 2, .time = 0.7};
  flock->forces.unknowns[internal::kLogDs] += 1;
  flock->forces.unknowns[internal::kLogDv] += 1.5;
  flock->forces.unknowns[internal::kLogTaper] += 1;
  flock->Relinearize();
}

Bird Moved(Bird bird, Rng* rng, double size) {
  for (double& p : bird.path) p += size * rng->Normal();
  for (double& p : bird.own) p += size * rng->Normal();
  return bird;
}

// Against the cost of the whole flock.
TEST(OneAnimal, ItsCostChangesAsThatOfAll) {
  WithFlock({.count = 6, .frames = 60}, {}, [](const WindowToRefine& window, CoupledFlock& flock) {
    HearAll(&flock);
    OneAnimal one(&flock);
    Rng rng(3);
    for (const std::size_t i : {0, 3, 5, 3}) {
      one.Choose(i);
      const double own = one.Cost(), all = flock.Cost();
      const Bird bird = (*window.birds)[i];
      one.Put(Moved(bird, &rng, 1e-3));
      const double change = flock.Cost() - all;
      EXPECT_GT(std::abs(change), 1);
      EXPECT_NEAR(one.Cost() - own, change, 1e-8 * all);
      if (i == 0) one.Put(bird);
      EXPECT_NEAR(one.Cost() - own, flock.Cost() - all, 1e-8 * all);
    }
  });
}

// Where it comes to rest the whole cost has no slope along its path and its own scalars.
TEST(OneAnimal, ComesToRestWhereTheCostOfAllHasNoSlope) {
  WithFlock({.count = 6, .frames = 60}, {}, [](const WindowToRefine& window, CoupledFlock& flock) {
    HearAll(&flock);
    OneAnimal one(&flock);
    constexpr std::size_t kAnimal = 2;
    one.Choose(kAnimal);
    const auto slope = [&] {
      Rng rng(8);
      double square = 0;
      for (int trial = 0; trial < 10; ++trial) {
        const Bird bird = (*window.birds)[kAnimal];
        const Bird next = Moved(bird, &rng, 1e-7);
        Bird last = bird;
        for (std::size_t k = 0; k < bird.path.size(); ++k)
          last.path[k] -= next.path[k] - bird.path[k];
        for (std::size_t k = 0; k < bird.own.size(); ++k) last.own[k] -= next.own[k] - bird.own[k];
        one.Put(next);
        const double up = flock.Cost();
        one.Put(last);
        const double down = flock.Cost();
        one.Put(bird);
        square += (up - down) * (up - down);
      }
      return std::sqrt(square);
    };
    const double before = slope(), cost = flock.Cost();
    const double own = one.Cost(), rest = one.Minimize(100);
    EXPECT_LT(flock.Cost(), cost);
    EXPECT_NEAR(rest - own, flock.Cost() - cost, 1e-8 * cost);
    EXPECT_LT(slope(), 0.02 * before);
  });
}

// An animal that is far from where it belongs, the others where they are.
TEST(DepthMoves, PutAnAnimalBack) {
  int asked = 0;
  const FlockSpec spec{.count = 6, .frames = 90};
  internal::SolveWindow(
      {}, Known(spec), Seen(spec), std::nullopt, 1, kFps, 1, {}, [&](const WindowToRefine& window) {
        ++asked;
        internal::FollowedFlock flock = internal::FollowForces({}, window);
        flock.Settle(window.model, 20);
        const double best = flock.improbable;
        for (std::size_t k = 2; k < flock.birds[1].path.size(); k += 3) {
          flock.birds[1].path[k] -= 0.3;
        }
        CoupledFlock moved = flock.Coupled(window.model);
        flock.Take(moved);
        const double worse = flock.improbable;
        ASSERT_GT(worse, best + 50);
        internal::MoveDepths(window.model, &flock);
        EXPECT_LT(flock.improbable, best + 0.1 * (worse - best));
        // And never away from there.
        const double at_best = flock.improbable;
        internal::MoveDepths(window.model, &flock);
        EXPECT_LT(flock.improbable, at_best + 0.5);  // accelerations count at depths of now
      });
  EXPECT_EQ(asked, 1);
}

}  // namespace
}  // namespace flocklift
