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
      const Bird bird = window.state.birds[i];
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
        const Bird bird = window.state.birds[kAnimal];
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

// Animals that were put far away come to rest on their way back, some of them where settling
// leaves them. Over many, for where one of them ends hangs on the last digits.
TEST(DepthMoves, LeadOutOfWhereSettlingEnds) {
  double gain = 0;
  const FlockSpec spec{.count = 6, .frames = 90};
  WithWindow(spec, {}, [&](const WindowToRefine& window) {
    const internal::FollowedFlock found = internal::FollowForces({}, window.state);
    for (std::size_t i = 0; i < found.birds.size(); ++i) {
      for (const double off : {-0.5, 0.3, 0.4, 0.5}) {
        internal::FollowedFlock flock = found;
        for (std::size_t k = 2; k < flock.birds[i].path.size(); k += 3) {
          flock.birds[i].path[k] += off;
        }
        for (int again = 0; again < 4; ++again) flock.Settle(window.state.model, 60);
        const double stuck = flock.improbable;
        internal::MoveDepths(window.state.model, &flock);
        EXPECT_LE(flock.improbable, stuck);
        gain += stuck - flock.improbable;
      }
    }
  });
  EXPECT_GT(gain, 15);
}

// A flock that has grown by 2 % has accelerations as much larger. They count for what they were
// beside the flock that it was, and would count for more by themselves.
TEST(FollowedFlock, KeepsTheScaleOfItsProbability) {
  const FlockSpec spec{.count = 6, .frames = 90};
  WithWindow(spec, {}, [&](const WindowToRefine& window) {
    internal::FollowedFlock found = internal::FollowForces({}, window.state);
    found.Settle(window.state.model, 60);
    internal::FollowedFlock grown = found;
    for (internal::Bird& bird : grown.birds) {
      for (std::size_t k = 2; k < bird.path.size(); k += 3) {
        bird.path[k] += 0.02;
      }
    }
    const auto costs_more = [&] {
      return grown.Coupled(window.state.model).Cost() - found.Coupled(window.state.model).Cost();
    };
    const double beside = costs_more();
    grown.scale->log_depth += 0.02;  // speed stays: it is held there
    EXPECT_GT(costs_more(), beside + 1);
  });
}

}  // namespace
}  // namespace flocklift
