// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/cost_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/fields/density.h"
#include "simulate/fields/distance_field.h"
#include "tests/simulate/fields/meshes.h"

namespace flocklift {
namespace {

ScalarField Empty(double spacing) {
  return DistanceField(GridOver({-1, -1, -1}, {1, 1, 1}, spacing), {});
}

// Houses, a trap that is open away from the goal, a wall with a window, and a hollow without doors.
std::vector<Solid> Village() {
  TriangleMesh hollow = BoxMesh({13, 1, 1}, {16, 4, 4});
  Append(Inverted(BoxMesh({13.6, 1.6, 1.6}, {15.4, 3.4, 3.4})), &hollow);
  return {Block{{2, 0, 0}, {3, 4, 5}}, Ball{{6, 3, 3}, 1.2},
          MeshDistance(TorusMesh(1.0, 0.4, 24, 12)),
          MeshDistance(BallMesh({10, 6, 2}, 1.3, 8, 12, 0.2)), MeshDistance(hollow),
          // The trap: a cup.
          Block{{7.9, 0.5, 4}, {8.5, 3.5, 7}}, Block{{5.5, 0.5, 4}, {8.5, 1.1, 7}},
          Block{{5.5, 2.9, 4}, {8.5, 3.5, 7}},
          // The wall and its window.
          Block{{11, -1, -2}, {11.7, 9, 3}}, Block{{11, -1, 4.5}, {11.7, 9, 8}},
          Block{{11, -1, 3}, {11.7, 4, 4.5}}, Block{{11, 5.5, 3}, {11.7, 9, 4.5}}};
}

const Grid kVillageGrid = GridOver({-2, -1, -2}, {17, 9, 8}, 0.35);
const std::vector<Solid> kGoals = {Ball{{15, 7, 6}, 0.8}};

const CostField& VillageField() {
  static const CostField field(DistanceField(kVillageGrid, Village()), {}, kGoals);
  return field;
}

void ExpectSame(const CostField& a, const CostField& b) {
  ASSERT_EQ(a.grid(), b.grid());
  for (std::size_t n = 0; n < a.grid().size(); ++n) ASSERT_EQ(a.Cost(n), b.Cost(n)) << n;
  EXPECT_EQ(std::memcmp(a.guide().data(), b.guide().data(), a.guide().size() * sizeof(GuideNode)),
            0);
}

double WorstError(double spacing, const std::vector<Solid>& goals) {
  const CostField field(Empty(spacing), {}, goals);
  double worst = 0;
  for (std::size_t n = 0; n < field.grid().size(); ++n) {
    const double exact = 0.6 * std::max(SignedDistance(goals, field.grid().Node(n)), 0.0);
    worst = std::max(worst, std::abs(field.Cost(n) - exact));
  }
  return worst;
}

// Without obstacles C is A times the distance to the nearest goal.
void ExpectFirstOrder(const std::vector<Solid>& goals) {
  double last = WorstError(1.0 / 8, goals);
  for (const double spacing : {1.0 / 16, 1.0 / 32}) {
    const double error = WorstError(spacing, goals);
    EXPECT_GT(std::log2(last / error), 0.75) << spacing << " " << error;
    last = error;
  }
  EXPECT_LT(last, 0.6 / 32);  // below the cost of one spacing
}

TEST(CostField, TheErrorFallsLinearlyForABall) { ExpectFirstOrder({Ball{{0.1, 0.05, 0}, 0.4}}); }

TEST(CostField, TheErrorFallsLinearlyForTwoGoals) {
  ExpectFirstOrder({Ball{{-0.5, -0.4, 0.3}, 0.35}, Ball{{0.6, 0.5, -0.2}, 0.3}});
}

TEST(CostField, TheDirectionNearsThatOfTheGoal) {
  const std::vector<Solid> goals = {Ball{{0.1, 0.05, 0}, 0.4}};
  double last = 1;
  for (const double spacing : {1.0 / 8, 1.0 / 16, 1.0 / 32}) {
    const CostField field(Empty(spacing), {}, goals);
    Rng rng(1);
    double sum = 0;
    int count = 0;
    for (int k = 0; k < 2000; ++k) {
      const Vec3d p{rng.Uniform(-1, 1), rng.Uniform(-1, 1), rng.Uniform(-1, 1)};
      if (SignedDistance(goals, p) <= 0) {
        EXPECT_EQ(field.Direction(p), (Vec3d{}));
        continue;
      }
      EXPECT_NEAR(Norm(field.Direction(p)), 1, 1e-6);
      sum += Norm(field.Direction(p) - Normalized(Vec3d{0.1, 0.05, 0} - p));
      ++count;
    }
    EXPECT_LT(sum / count, 0.7 * last);
    last = sum / count;
  }
  EXPECT_LT(last, 0.05);
}

TEST(CostField, RepulsionRaisesTheCostNearObstacles) {
  const CostField& field = VillageField();
  const double l = field.grid().spacing;
  int checked = 0;
  for (std::size_t n = 0; n < field.grid().size(); ++n) {
    const double phi = field.guide()[n].distance;
    EXPECT_EQ(field.IsWall(n), phi < 0);
    if (phi < 0 || !std::isfinite(field.Cost(n)) || field.Cost(n) == 0) continue;
    // |grad C| = A + B h(phi / 2a), away from the goal's rim.
    if (SignedDistance(kGoals, field.grid().Node(n)) < l) continue;
    const Vec3d p = field.grid().Node(n);
    const int i = static_cast<int>(n % field.grid().nx);
    const int j = static_cast<int>(n / field.grid().nx % field.grid().ny);
    const int k = static_cast<int>(n / field.grid().nx / field.grid().ny);
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      double least = field.Cost(n);
      for (const int side : {-1, 1}) {
        const int a = i + (axis == 0 ? side : 0), b = j + (axis == 1 ? side : 0);
        const int c = k + (axis == 2 ? side : 0);
        if (a < 0 || b < 0 || c < 0 || a >= field.grid().nx || b >= field.grid().ny ||
            c >= field.grid().nz) {
          continue;
        }
        least = std::min<double>(least, field.Cost(field.grid().Index(a, b, c)));
      }
      sum += (field.Cost(n) - least) * (field.Cost(n) - least);
    }
    const double expected = 0.6 + 0.4 * Bell(phi / (2 * std::sqrt(3.0) * l));
    ASSERT_NEAR(std::sqrt(sum) / l, expected, 1e-3) << p.x << " " << p.y << " " << p.z;
    ++checked;
  }
  EXPECT_GT(checked, 20000);
}

TEST(CostField, CostFallsAlongEveryPartOfTheDirection) {
  const CostField& field = VillageField();
  const Grid& g = field.grid();
  int free = 0;
  std::size_t cut_off = 0;
  for (std::size_t n = 0; n < g.size(); ++n) {
    if (field.IsWall(n) || field.Cost(n) == 0) continue;
    const GuideNode& v = field.guide()[n];
    if (!std::isfinite(field.Cost(n))) {
      EXPECT_EQ(v.x * v.x + v.y * v.y + v.z * v.z, 0);
      ++cut_off;
      continue;
    }
    ++free;
    ASSERT_NEAR(v.x * v.x + v.y * v.y + v.z * v.z, 1, 1e-5);
    const auto step = [](float part) { return part > 0 ? 1 : part < 0 ? -1 : 0; };
    const auto lower = [&](std::ptrdiff_t offset) {
      return field.Cost(n + offset) < field.Cost(n);
    };
    EXPECT_TRUE(v.x == 0 || lower(step(v.x)));
    EXPECT_TRUE(v.y == 0 || lower(step(v.y) * g.nx));
    EXPECT_TRUE(v.z == 0 || lower(static_cast<std::ptrdiff_t>(step(v.z)) * g.nx * g.ny));
  }
  EXPECT_GT(free, 20000);
  EXPECT_EQ(cut_off, field.unreachable());
  EXPECT_GT(cut_off, 50u);  // the hollow
}

// No local minimum: who follows the sampled direction from any free node arrives.
TEST(CostField, EveryFreeNodeLeadsToAGoal) {
  const CostField& field = VillageField();
  const Grid& g = field.grid();
  const double step = 0.2 * g.spacing;
  const ScalarField distance = DistanceField(g, Village());
  int walks = 0;
  double deepest = 0;
  for (std::size_t n = 0; n < g.size(); n += 7) {
    if (field.IsWall(n) || !std::isfinite(field.Cost(n))) continue;
    Vec3d p = g.Node(n);
    // The way is no longer than its cost at the least cost per metre; twice for the corners cut.
    const int steps = static_cast<int>(2 * field.Cost(n) / 0.6 / step) + 20;
    int taken = 0;
    for (; taken < steps && SignedDistance(kGoals, p) > 0; ++taken) {
      p += step * field.Direction(p);
      deepest = std::min(deepest, distance.Sample(p));
    }
    EXPECT_LT(taken, steps) << n << " stuck at " << p.x << " " << p.y << " " << p.z;
    ++walks;
  }
  EXPECT_GT(walks, 3000);
  EXPECT_GT(deepest, -0.5 * g.spacing);  // corners are cut by less than half a cell
}

TEST(CostField, WallsLeadOut) {
  const CostField& field = VillageField();
  const Vec3d p{2.25, 2, 2.5};  // in the first house, nearer to its low x side
  EXPECT_LT(field.Direction(p).x, -0.99);
}

TEST(CostField, AMovedGoalGivesTheFreshField) {
  const ScalarField distance = DistanceField(kVillageGrid, Village());
  std::vector<Solid> goals = {Ball{{15, 7, 6}, 0.8}, Ball{{0, 7, 0}, 0.5}, Ball{{5, 7, 7}, 0.1},
                              Ball{{8, 7, 6}, 0.3}, Ball{{5, 5, 3}, 0.3}};
  CostField kept(distance, {}, goals);
  for (int move = 0; move < 4; ++move) {
    goals[2] = Ball{{5 + 0.3 * move, 7 - 0.2 * move, 7}, 0.1};
    kept.SetGoals(goals);
    EXPECT_TRUE(kept.covers_all());  // only the goal's surroundings were computed
    ExpectSame(kept, CostField(distance, {}, goals));
  }
  goals.resize(1);
  kept.SetGoals(goals);
  kept.CoverAll();
  ExpectSame(kept, CostField(distance, {}, goals));
}

TEST(CostField, WhatIsCoveredIsTheFreshFields) {
  const ScalarField distance = DistanceField(kVillageGrid, Village());
  CostField kept(distance, {}, kGoals);
  Rng rng(8);
  for (int move = 0; move < 5; ++move) {
    const std::vector<Solid> goals = {Ball{{3.0 + 2 * move, 7, 6}, 0.4}};
    kept.SetGoals(goals);
    const CostField fresh(distance, {}, goals);
    double dearest = 0;
    for (int ask = 0; ask < 50; ++ask) {
      const std::size_t node = kept.grid().Nearest(
          {rng.Uniform(3, 7) + 2 * move - 2, rng.Uniform(6, 8), rng.Uniform(5, 7)});
      kept.Cover({{node}});
      ASSERT_EQ(kept.Cost(node), fresh.Cost(node));
      ASSERT_EQ(std::memcmp(&kept.guide()[node], &fresh.guide()[node], sizeof(GuideNode)), 0);
      if (!kept.IsWall(node)) dearest = std::max<double>(dearest, kept.Cost(node));
    }
    // What is far dearer was not computed.
    EXPECT_FALSE(kept.covers_all());
    for (std::size_t n = 0; n < kept.grid().size(); ++n) {
      if (fresh.Cost(n) <= dearest + 1) continue;
      ASSERT_EQ(kept.Cost(n), Eikonal::kInfinite);
    }
  }
}

TEST(CostField, CrowdedPlacesAreGoneRound) {
  const Grid grid = GridOver({0, 0, 0}, {10, 6, 1}, 0.25);
  const ScalarField distance = DistanceField(grid, {});
  const std::vector<Solid> goals = {Ball{{9.5, 3, 0.5}, 0.3}};
  Rng rng(2);
  std::vector<Vec3d> crowd;
  for (int k = 0; k < 800; ++k) {
    crowd.push_back({rng.Uniform(4, 5), rng.Uniform(2, 4), rng.Uniform(0, 1)});
  }
  std::vector<float> extra = DensityField(grid, crowd).values;
  for (float& e : extra) e *= 0.02F;
  CostField field(distance, {}, goals);
  const Vec3d start{3, 3.2, 0.5};
  const double straight = field.Direction(start).y;
  field.SetExtra(extra);
  field.CoverAll();
  EXPECT_GT(field.Direction(start).y, straight + 0.3);
  CostField fresh(distance, {}, goals);
  fresh.SetExtra(extra);
  fresh.CoverAll();
  ExpectSame(field, fresh);
  field.SetExtra({});
  field.CoverAll();
  ExpectSame(field, CostField(distance, {}, goals));
}

TEST(CostField, TheSameBytesAtAnyThreadCount) {
  const ScalarField distance = DistanceField(kVillageGrid, Village());
  ExpectSame(CostField(distance, {}, kGoals, 1), CostField(distance, {}, kGoals, 2));
}

TEST(CostField, AGoalBetweenNodesOrInAWallTakesTheNearestFreeNode) {
  const Grid grid{{0, 0, 0}, 1, 9, 9, 9};
  const std::vector<Solid> house = {Block{{1.5, 1.5, 1.5}, {4.5, 4.5, 4.5}}};
  const ScalarField distance = DistanceField(grid, house);
  const CostField between(distance, {}, std::vector<Solid>{Ball{{6.3, 6.4, 7.2}, 0.01}});
  EXPECT_EQ(between.Cost(grid.Index(6, 6, 7)), 0);
  EXPECT_GT(between.Cost(grid.Index(7, 6, 7)), 0);
  const CostField walled(distance, {}, std::vector<Solid>{Ball{{4.2, 3, 3}, 0.1}});
  EXPECT_EQ(walled.Cost(grid.Index(5, 3, 3)), 0);
  EXPECT_THROW(CostField(distance, {}, {}), std::invalid_argument);
}

TEST(CostField, AFlatGridMakesAFlatField) {
  const Grid grid{{0, 0, 0}, 0.5, 21, 21, 1};
  const CostField field(DistanceField(grid, {}), {}, std::vector<Solid>{Ball{{2, 5, 0}, 1}});
  const Vec3d v = field.Direction({8, 5, 0});
  EXPECT_NEAR(v.x, -1, 1e-6);
  EXPECT_EQ(v.z, 0);
}

}  // namespace
}  // namespace flocklift
