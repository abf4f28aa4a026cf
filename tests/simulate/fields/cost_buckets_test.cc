// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/cost_buckets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

TEST(CostBuckets, GiveEverythingBackAboutInOrder) {
  constexpr float kWidth = 0.03F;
  CostBuckets front;
  for (int round = 0; round < 2; ++round) {  // empty again after Clear
    front.Clear(kWidth);
    EXPECT_TRUE(front.Empty());
    Rng rng(3);
    std::vector<float> waiting;
    std::uint32_t pushed = 0, popped = 0;
    const auto push = [&](double cost) {
      front.Push(static_cast<float>(cost), pushed++);
      waiting.push_back(static_cast<float>(cost));
    };
    for (int k = 0; k < 300; ++k) push(rng.Uniform(0, 5));
    while (!front.Empty()) {
      const float least = *std::min_element(waiting.begin(), waiting.end());
      EXPECT_LE(front.LeastCost(), least);
      EXPECT_GT(front.LeastCost(), least - 1.01F * kWidth);
      const CostBuckets::Entry entry = front.Pop();
      EXPECT_LE(entry.cost, least + 1.01F * kWidth);
      const auto it = std::find(waiting.begin(), waiting.end(), entry.cost);
      ASSERT_NE(it, waiting.end());
      waiting.erase(it);
      ++popped;
      if (pushed < 600) push(rng.Uniform(0.5, 1.5) * static_cast<double>(entry.cost));
    }
    EXPECT_TRUE(waiting.empty());
    EXPECT_EQ(popped, pushed);
    if (round == 0) front.Push(1, 0);
  }
}

TEST(CostBuckets, HoldWhatCostsMoreThanAllBuckets) {
  CostBuckets front;
  front.Clear(1e-6F);
  front.Push(1e9F, 1);
  front.Push(2e9F, 2);
  front.Push(1e-6F, 3);
  EXPECT_EQ(front.Pop().node, 3U);
  EXPECT_LT(front.LeastCost(), 1e9F);
  EXPECT_EQ(front.Pop().node + front.Pop().node, 3U);
  EXPECT_TRUE(front.Empty());
}

}  // namespace
}  // namespace flocklift::internal
