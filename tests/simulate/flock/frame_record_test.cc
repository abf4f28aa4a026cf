// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/frame_record.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace flocklift {
namespace {

constexpr std::size_t kAnimals = 3;

FlockState StateOf(int frame) {
  FlockState state;
  for (std::size_t k = 0; k < kAnimals; ++k) {
    const double number = 10.0 * frame + static_cast<double>(k);
    state.id.push_back(static_cast<Id>(k + 1));
    state.position.push_back({number, 0, 1});
    state.velocity.push_back({0, -number, 2});
  }
  return state;
}

void ExpectFrames(const Trajectories& truth, int first, int last) {
  for (std::size_t k = 0; k < kAnimals; ++k) {
    const auto& points = truth.trajectories[k].points;
    ASSERT_EQ(points.size(), static_cast<std::size_t>(last - first + 1));
    for (std::size_t n = 0; n < points.size(); ++n) {
      const int frame = first + static_cast<int>(n);
      EXPECT_EQ(points[n].frame, frame);
      EXPECT_EQ(points[n].position, StateOf(frame).position[k]);
      EXPECT_EQ(points[n].velocity, StateOf(frame).velocity[k]);
    }
  }
}

TEST(FrameRecord, KeepsEveryFrameOnceAndInOrder) {
  Trajectories truth;
  truth.trajectories.resize(kAnimals);
  FrameRecord record(&truth);
  for (int frame = 5; frame <= 104; ++frame) {
    record.Add(frame, StateOf(frame));
    if (frame != 21) continue;
    record.Flush();  // as before a checkpoint
    ExpectFrames(truth, 5, 21);
  }
  record.Flush();
  record.Flush();
  ExpectFrames(truth, 5, 104);
}

TEST(FrameRecord, RefusesAStateOfOtherAnimals) {
  Trajectories truth;
  truth.trajectories.resize(kAnimals + 1);
  FrameRecord record(&truth);
  EXPECT_THROW(record.Add(1, StateOf(1)), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
