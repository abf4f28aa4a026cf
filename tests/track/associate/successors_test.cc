// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/successors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

TrackEnd At(int frame, const Vec2d& p, const Vec2d& v) {
  return {frame, {.position = p, .velocity = v, .pp = 1, .pv = 0, .vv = 1}};
}

// Nothing within the bounds is missed: all pairs are the oracle.
TEST(SuccessorsTest, MissesNothingWithinTheBounds) {
  Rng rng(5);
  std::vector<TrackEnd> beginnings;
  for (int k = 0; k < 800; ++k) {
    beginnings.push_back(At(1 + static_cast<int>(rng.Uniform(0, 200)),
                            {rng.Uniform(0, 600), rng.Uniform(0, 400)},
                            {rng.Uniform(-6, 6), rng.Uniform(-6, 6)}));
  }
  constexpr int kMaxGap = 45, kEnds = 3000;
  constexpr double kSpeedReach = 2;
  const auto reach = [](int gap) { return 3 + 0.5 * gap; };
  for (const double speed : {0.5, 5.0, 50.0}) {
    const Successors successors(beginnings, speed);
    std::size_t wanted = 0, found = 0;
    for (int k = 0; k < kEnds; ++k) {
      const TrackEnd end =
          At(1 + static_cast<int>(rng.Uniform(0, 200)), {rng.Uniform(0, 600), rng.Uniform(0, 400)},
             {rng.Uniform(-6, 6), rng.Uniform(-6, 6)});
      const std::vector<int> near = successors.Find(end, kMaxGap, reach, kSpeedReach);
      EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
      found += near.size();
      for (std::size_t j = 0; j < beginnings.size(); ++j) {
        const TrackEnd& b = beginnings[j];
        const int gap = b.frame - end.frame;
        const Vec2d &p = end.state.position, &v = end.state.velocity;
        const double away =
            std::hypot(b.state.position.x - p.x - gap * v.x, b.state.position.y - p.y - gap * v.y);
        const double other = std::hypot(b.state.velocity.x - v.x, b.state.velocity.y - v.y);
        if (gap < 1 || gap > kMaxGap || away > reach(gap) || other > kSpeedReach) continue;
        ++wanted;
        EXPECT_TRUE(std::binary_search(near.begin(), near.end(), static_cast<int>(j)));
      }
    }
    EXPECT_GT(wanted, 50u);
    // Far fewer than all pairs, the most so at the scale that is right for these.
    EXPECT_LT(found, kEnds * beginnings.size() / (speed == 5.0 ? 100 : 10));
  }
}

TEST(SuccessorsTest, NoBeginningsNoSuccessors) {
  const Successors none({}, 5);
  EXPECT_TRUE(none.Find(
                      At(1, {0, 0}, {1, 1}), 45, [](int) { return 100.0; }, 10)
                  .empty());
}

}  // namespace
}  // namespace flocklift
