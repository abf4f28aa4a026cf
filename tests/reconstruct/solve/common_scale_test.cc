// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/common_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "reconstruct/solve/batch_model.h"
#include "reconstruct/solve/batch_start.h"
#include "tests/reconstruct/circling_flock.h"

namespace flocklift::internal {
namespace {

// A small flock at the start of a solve.
struct Start {
  FlockSpec flock{.count = 4, .frames = 60};
  Segments segments;
  BatchModel model;
  std::vector<Bird> birds;
  Eigen::VectorXd shared;

  explicit Start(const Knowledge& knowledge) {
    const Camera camera = WatchingCamera();
    segments =
        MakeSegments({}, Observe(flock, {}, CirclingFlock(flock), camera), camera, flock.fps);
    const ScaleGuess guess = GuessScale(knowledge, segments);
    model = MakeModel({}, knowledge, segments, guess, std::nullopt, flock.fps);
    for (const Segment& segment : segments.segments) {
      birds.push_back(StartBird(model, knowledge, guess, segment, flock.fps, 1));
    }
    shared = StartOfShared(model);
  }

  double Cost() const {  // without smoothness
    double cost = SharedPriors(model, shared, nullptr, nullptr);
    for (const Bird& bird : birds) {
      ForEachRow(model, bird, shared, false, [&](Term term, const ResidualRow& row) {
        if (term != Term::kAcceleration) cost += RobustCost(term, row.residual);
      });
    }
    return cost;
  }
};

Knowledge Known() {
  Knowledge knowledge;
  knowledge.speed = Uncertain{10, 1};
  knowledge.use_size = false;
  return knowledge;
}

TEST(CommonScale, IsThatOfTheSpeedWhereNothingElseIsKnown) {
  Start start(Known());
  Grow(0.3, start.model, &start.birds, &start.shared);
  const double depth = start.birds[0].path[2];
  FindCommonScale(start.model, &start.birds, &start.shared);
  EXPECT_NEAR(start.shared[kFlockLogSpeed], std::log(10.0), 0.01);
  EXPECT_NEAR(start.birds[0].path[2], depth - 0.3, 0.02);
}

TEST(CommonScale, IsALowestCost) {
  Knowledge knowledge = Known();
  knowledge.use_size = true;
  knowledge.wingspan = Uncertain{0.6, 0.03};
  knowledge.anchors = {{12, 2, {1, 2, 43}, 2}};
  Start start(knowledge);
  Grow(-0.2, start.model, &start.birds, &start.shared);
  FindCommonScale(start.model, &start.birds, &start.shared);
  const double least = start.Cost();
  for (const double step : {-0.02, 0.02}) {
    Grow(step, start.model, &start.birds, &start.shared);
    EXPECT_GT(start.Cost(), least) << step;
    Grow(-step, start.model, &start.birds, &start.shared);
  }
}

// Whatever scale it comes with.
TEST(CommonScale, ForgetsWhereItWas) {
  Start small(Known()), large(Known());
  Grow(0.5, large.model, &large.birds, &large.shared);
  FindCommonScale(small.model, &small.birds, &small.shared);
  FindCommonScale(large.model, &large.birds, &large.shared);
  for (std::size_t k = 2; k < small.birds[1].path.size(); k += 3) {
    EXPECT_NEAR(small.birds[1].path[k], large.birds[1].path[k], 1e-4);
  }
}

}  // namespace
}  // namespace flocklift::internal
