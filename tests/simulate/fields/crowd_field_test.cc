// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/crowd_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/fields/distance_field.h"

namespace flocklift {
namespace {

using Goals = std::vector<std::vector<Solid>>;

// Everybody at a node, with one velocity: densities and flows are those of one animal a node.
struct Column {
  std::vector<Vec3d> positions, velocities;

  Column(const Grid& grid, const Vec3d& velocity, int each) {
    for (std::size_t n = 0; n < grid.size(); ++n) {
      for (int k = 0; k < each; ++k) {
        positions.push_back(grid.Node(n));
        velocities.push_back(velocity);
      }
    }
  }
};

TEST(CrowdField, AnEmptyFieldGivesStraightLinesAtFullSpeed) {
  CrowdOptions options;
  options.max_speed = 1.6;
  const Ball goal{{0.1, 0.05, 0}, 0.4};
  const double per_metre = 0.8 + 0.8 / 1.6;  // (alpha f + beta) / f
  double last_cost = 0, last_turn = 0;
  for (const double spacing : {1.0 / 8, 1.0 / 16, 1.0 / 32}) {
    const Grid grid = GridOver({-1, -1, -1}, {1, 1, 1}, spacing);
    const CrowdField field(DistanceField(grid, {}), options, Goals{{goal}});
    double cost = 0, turn = 0;
    for (std::size_t n = 0; n < grid.size(); ++n) {
      const double exact = per_metre * std::max(goal(grid.Node(n)), 0.0);
      cost = std::max(cost, std::abs(field.Potential(0, n) - exact));
    }
    Rng rng(1);
    for (int k = 0; k < 1000; ++k) {
      const Vec3d p{rng.Uniform(-1, 1), rng.Uniform(-1, 1), rng.Uniform(-1, 1)};
      if (goal(p) < spacing) continue;
      const Vec3d v = field.Velocity(0, p);
      EXPECT_LE(Norm(v), 1.6 + 1e-6);
      turn += Norm(v / 1.6 - Normalized(goal.centre - p)) / 1000;
    }
    if (last_cost > 0) {
      EXPECT_LT(cost, 0.65 * last_cost);  // first order
      EXPECT_LT(turn, 0.75 * last_turn);
    }
    last_cost = cost;
    last_turn = turn;
    EXPECT_EQ(field.Velocity(0, goal.centre), (Vec3d{}));
  }
  EXPECT_LT(last_turn, 0.05);
}

TEST(CrowdField, DensityIsSharedOutByTheSmallestFactor) {
  const Grid grid{{0, 0, 0}, 2, 4, 4, 4};
  for (const double exponent : {1.0, 2.0}) {
    CrowdOptions options;
    options.density_exponent = exponent;
    CrowdField field(DistanceField(grid, {}), options, Goals{{Ball{{0, 0, 0}, 1}}});
    field.Update(std::vector<Vec3d>{{2.5, 3, 2}}, std::vector<Vec3d>{{1, 2, 3}});
    EXPECT_NEAR(field.Density(grid.Index(1, 1, 1)), std::pow(0.5, exponent), 1e-12);
    EXPECT_NEAR(field.Density(grid.Index(2, 1, 1)), std::pow(0.25, exponent), 1e-12);
    EXPECT_NEAR(field.Density(grid.Index(2, 2, 1)), std::pow(0.25, exponent), 1e-12);
    EXPECT_EQ(field.Density(grid.Index(1, 1, 2)), 0);
    EXPECT_NEAR(Norm(field.Flow(grid.Index(2, 1, 1)) - Vec3d{1, 2, 3}), 0, 1e-12);
    // No animal is a crowd to its neighbours, and none is less than that at its own node.
    Rng rng(3);
    for (int k = 0; k < 200; ++k) {
      const Vec3d p{rng.Uniform(0, 6), rng.Uniform(0, 6), rng.Uniform(0, 6)};
      field.Update(std::vector<Vec3d>{p}, std::vector<Vec3d>{{}});
      const double limit = std::exp2(-exponent);
      for (std::size_t n = 0; n < grid.size(); ++n) {
        if (n == grid.Nearest(p)) {
          EXPECT_GE(field.Density(n), limit - 1e-12);
        } else {
          EXPECT_LE(field.Density(n), limit + 1e-12);
        }
      }
    }
  }
}

TEST(CrowdField, ADenseCrowdSetsTheSpeed) {
  const Grid grid{{0, 0, 0}, 1, 12, 8, 1};
  CrowdOptions options;
  options.max_speed = 2;
  options.min_speed = 0.1;
  const Goals ends = {{Block{{11, 0, 0}, {11, 7, 0}}}, {Block{{0, 0, 0}, {0, 7, 0}}}};
  CrowdField field(DistanceField(grid, {}), options, ends);
  const Vec3d middle{5.5, 3.5, 0};
  EXPECT_NEAR(field.Velocity(0, middle).x, 2, 1e-6);
  EXPECT_NEAR(field.Velocity(1, middle).x, -2, 1e-6);

  const Column dense(grid, {0.7, 0.2, 0}, 2);  // 2 a node, more than density_high
  field.Update(dense.positions, dense.velocities);
  EXPECT_NEAR(field.Velocity(0, middle).x, 0.7, 1e-6);   // with the flow: its speed
  EXPECT_NEAR(field.Velocity(1, middle).x, -0.1, 1e-6);  // against it: hardly at all
  // The potential is the cost of that speed over the way: (alpha f + beta) / f each metre.
  const std::size_t start = grid.Index(1, 3, 0), end = grid.Index(10, 3, 0);
  EXPECT_NEAR(field.Potential(0, start), 10 * (0.8 + 0.8 / 0.7), 1e-3);
  EXPECT_NEAR(field.Potential(1, end), 10 * (0.8 + 0.8 / 0.1), 1e-2);

  const Column half(grid, {0.7, 0.2, 0}, 1);  // 1 a node, halfway between low and high
  field.Update(half.positions, half.velocities);
  EXPECT_NEAR(field.Velocity(0, middle).x, 0.5 * (2 + 0.7), 1e-6);
  EXPECT_NEAR(field.Velocity(1, middle).x, -0.5 * (2 + 0.1), 1e-6);

  field.Update({}, {});
  EXPECT_NEAR(field.Velocity(0, middle).x, 2, 1e-6);
}

TEST(CrowdField, AKnotOfPeopleIsGoneRound) {
  const Grid grid{{0, 0, 0}, 1, 30, 21, 1};
  CrowdField field(DistanceField(grid, {}), {}, Goals{{Ball{{28, 10, 0}, 1}}});
  EXPECT_NEAR(field.Velocity(0, {8, 11, 0}).y, 0, 0.1);
  std::vector<Vec3d> knot;
  for (int i = 13; i < 17; ++i) {
    for (int j = 6; j < 14; ++j) knot.insert(knot.end(), 2, Vec3d{1.0 * i, 1.0 * j, 0});
  }
  field.Update(knot, std::vector<Vec3d>(knot.size()));
  EXPECT_GT(field.Velocity(0, {8, 11, 0}).y, 0.3);
}

TEST(CrowdField, WallsAreGoneRound) {
  const Grid grid{{0, 0, 0}, 0.5, 31, 21, 1};
  const std::vector<Solid> wall = {Block{{7, -1, -1}, {8, 8, 1}}};
  const CrowdField field(DistanceField(grid, wall), {}, Goals{{Ball{{14, 2, 0}, 1}}});
  Vec3d p{1, 2, 0};
  int taken = 0;
  double highest = 0;
  for (; taken < 4000 && Norm(p - Vec3d{14, 2, 0}) > 1; ++taken) {
    p += 0.05 * field.Velocity(0, p);
    highest = std::max(highest, p.y);
    EXPECT_GT(SignedDistance(wall, p), -0.25);
  }
  EXPECT_LT(taken, 4000);
  EXPECT_GT(highest, 7.9);
}

TEST(CrowdField, GoalsThatMoveMakeTheFieldOfTheNewOnes) {
  const Grid grid{{0, 0, 0}, 0.5, 31, 21, 1};
  const ScalarField distance = DistanceField(grid, std::vector<Solid>{Ball{{6, 5, 0}, 2}});
  const Goals before = {{Ball{{1, 1, 0}, 1}}, {Ball{{14, 2, 0}, 1}}};
  const Goals after = {{Ball{{12, 8, 0}, 1}}, {Ball{{2, 9, 0}, 0.1}, Ball{{14, 2, 0}, 1}}};
  const std::vector<Vec3d> positions = {{3, 3, 0}, {3.2, 3.1, 0}}, velocities = {{1, 0, 0}, {}};
  CrowdField moved(distance, {}, before), fresh(distance, {}, after);
  moved.SetGoals(after);
  moved.Update(positions, velocities);
  fresh.Update(positions, velocities);
  for (std::size_t group = 0; group < 2; ++group) {
    for (std::size_t n = 0; n < grid.size(); ++n) {
      ASSERT_EQ(moved.Potential(group, n), fresh.Potential(group, n));
      ASSERT_EQ(moved.Velocity(group, grid.Node(n)), fresh.Velocity(group, grid.Node(n)));
    }
  }
  EXPECT_THROW(moved.SetGoals(Goals{after[0]}), std::invalid_argument);
}

// How far rows of a corridor belong to one direction: the mean of ((a - b) / (a + b))^2 over rows
// in which a walk one way and b the other (M. Rex, H. Loewen, Phys. Rev. E 75 (2007) 051402).
double LaneOrder(const std::vector<Vec3d>& positions, int rows) {
  std::vector<double> right(rows), all(rows);
  for (std::size_t a = 0; a < positions.size(); ++a) {
    const int row = std::clamp(static_cast<int>(positions[a].y), 0, rows - 1);
    right[row] += a % 2 == 0 ? 1 : -1;
    ++all[row];
  }
  double sum = 0;
  for (std::size_t a = 0; a < positions.size(); ++a) {
    const int row = std::clamp(static_cast<int>(positions[a].y), 0, rows - 1);
    sum += std::pow(right[row] / all[row], 2);
  }
  return sum / static_cast<double>(positions.size());
}

// Two groups that walk through each other in a corridor, everybody anew from the start at the end.
std::vector<Vec3d> WalkThroughEachOther(int steps, int threads) {
  constexpr int kLength = 60, kWidth = 16;
  const Grid grid{{0, 0, 0}, 1, kLength + 1, kWidth + 1, 1};
  const Goals ends = {{Block{{kLength, 0, 0}, {kLength, kWidth, 0}}},
                      {Block{{0, 0, 0}, {0, kWidth, 0}}}};
  CrowdField field(DistanceField(grid, {}), {}, ends, threads);
  Rng rng(11);
  std::vector<Vec3d> positions(400), velocities(400);
  for (Vec3d& p : positions) p = {rng.Uniform(0, kLength), rng.Uniform(0, kWidth), 0};
  for (int step = 0; step < steps; ++step) {
    field.Update(positions, velocities);
    for (std::size_t a = 0; a < positions.size(); ++a) {
      velocities[a] = field.Velocity(a % 2, positions[a]);
      positions[a] += 0.4 * velocities[a];
      if (a % 2 == 0 && positions[a].x >= kLength - 0.5) positions[a].x -= kLength - 0.5;
      if (a % 2 == 1 && positions[a].x <= 0.5) positions[a].x += kLength - 0.5;
    }
  }
  return positions;
}

TEST(CrowdField, OpposingGroupsFormLanes) {
  const double before = LaneOrder(WalkThroughEachOther(0, 1), 16);
  const double after = LaneOrder(WalkThroughEachOther(400, 1), 16);
  RecordProperty("lane_order_before", std::to_string(before));
  RecordProperty("lane_order_after", std::to_string(after));
  EXPECT_LT(before, 0.2);
  EXPECT_GT(after, before + 0.3) << "from " << before;
}

TEST(CrowdField, TheSameBytesAtAnyThreadCount) {
  EXPECT_EQ(WalkThroughEachOther(40, 1), WalkThroughEachOther(40, 2));
}

TEST(CrowdField, RefusesNonsense) {
  const ScalarField distance = DistanceField({{0, 0, 0}, 1, 3, 3, 1}, {});
  const Goals goals = {{Ball{{0, 0, 0}, 1}}};
  const auto make = [&](auto change) {
    CrowdOptions options;
    change(&options);
    return CrowdField(distance, options, goals);
  };
  EXPECT_THROW(make([](CrowdOptions* o) { o->min_speed = 0; }), std::invalid_argument);
  EXPECT_THROW(make([](CrowdOptions* o) { o->time_weight = 0; }), std::invalid_argument);
  EXPECT_THROW(make([](CrowdOptions* o) { o->density_low = 0.4; }), std::invalid_argument);
  EXPECT_THROW(make([](CrowdOptions* o) { o->density_high = 0.5; }), std::invalid_argument);
  EXPECT_THROW(CrowdField(distance, {}, Goals{{}}), std::invalid_argument);
  CrowdField field(distance, {}, goals);
  EXPECT_THROW(field.Update(std::vector<Vec3d>(2), {}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
