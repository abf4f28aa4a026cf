// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/pair_forces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

#include "simulate/flock/shape_pairs.h"
#include "simulate/flock/zone_pairs.h"
#include "tests/simulate/flock/pair_sums.h"

namespace flocklift {
namespace {

// All pairs that `neighbours(k, j)` lets through, numbers in the order of the sort.
template <typename Rules, typename Neighbours>
ByAnimal BruteForce(const Bodies<double>& s, const Rules& rules, const Neighbours& neighbours) {
  ByAnimal result{std::vector<Vec3d>(s.size()), std::vector<double>(s.size())};
  for (std::size_t k = 0; k < s.size(); ++k) {
    const auto own = rules.For(s.Velocity(k));
    typename Rules::Sums sums;
    for (std::size_t j = 0; j < s.size(); ++j) {
      if (j == k || !neighbours(k, j)) continue;
      sums += own.Pair(s.Position(j) - s.Position(k), s.Velocity(j) - s.Velocity(k));
    }
    result.acceleration[s.agent[k]] = own.Finish(sums);
    result.neighbours[s.agent[k]] = sums.Neighbours();
  }
  return result;
}
bool Anyone(std::size_t, std::size_t) { return true; }

void ExpectSame(const ByAnimal& actual, const ByAnimal& expected, double tolerance) {
  ASSERT_EQ(actual.acceleration.size(), expected.acceleration.size());
  for (std::size_t k = 0; k < expected.acceleration.size(); ++k) {
    EXPECT_LE(Norm(actual.acceleration[k] - expected.acceleration[k]),
              tolerance * (1 + Norm(expected.acceleration[k])))
        << k;
    EXPECT_NEAR(actual.neighbours[k], expected.neighbours[k],
                tolerance * (1 + expected.neighbours[k]))
        << k;
  }
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(PairForces, BoidsAreBruteForce) {
  for (const NamedFlock& flock : ManyFlocks()) {
    SCOPED_TRACE(flock.name);
    const auto hard = PlainRules(0.4, 1.05), soft = PlainRules(0.4, 1.05, 0.3);
    const SortedFlock<double> sorted(flock, Reach(soft));
    ExpectSame(sorted.Sum(hard, "scalar"),
               BruteForce(sorted.bodies, MakeBoidsPairs<double>(hard, HardEdge{}), Anyone), 1e-12);
    ExpectSame(sorted.Sum(soft, "scalar"),
               BruteForce(sorted.bodies, MakeBoidsPairs<double>(soft, 0.3), Anyone), 1e-12);
  }
}

TEST(PairForces, BlindBoidsAreBruteForce) {
  for (const NamedFlock& flock : ManyFlocks()) {
    SCOPED_TRACE(flock.name);
    const double cosine = SightCosine(2.0);
    const auto hard = BlindRules(2.0), soft = BlindRules(2.0, 0.3, 0.2);
    const SortedFlock<double> sorted(flock, Reach(soft));
    const ViewCone<double, HardEdge> hard_view{{}, cosine, {}};
    const ViewCone<double> soft_view{{}, cosine, 0.2};
    ExpectSame(
        sorted.Sum(hard, "scalar"),
        BruteForce(sorted.bodies, MakeBoidsPairs<double>(hard, HardEdge{}, hard_view), Anyone),
        1e-12);
    ExpectSame(sorted.Sum(soft, "scalar"),
               BruteForce(sorted.bodies, MakeBoidsPairs<double>(soft, 0.3, soft_view), Anyone),
               1e-12);
  }
}

TEST(PairForces, ABlindAngleHidesItsShareOfTheSphere) {
  const NamedFlock flock = RandomFlock("", 3000, {8, 8, 8}, 21);
  const SortedFlock<double> sorted(flock, 1.05);
  const double all = Mean(sorted.Sum(PlainRules(0.4, 1.05), "scalar").neighbours);
  for (const double blind : {0.5, 2.0, std::numbers::pi}) {
    const double seen = Mean(sorted.Sum(BlindRules(blind), "scalar").neighbours);
    EXPECT_NEAR(seen / all, 0.5 * (1 + std::cos(0.5 * blind)), 0.01);
  }
}

TEST(PairForces, ZonesAreBruteForce) {
  for (const NamedFlock& flock : ManyFlocks()) {
    SCOPED_TRACE(flock.name);
    const ZoneParameters hard{0.3, 0.6, 1, 0.2, 3, 13, 0}, soft{0.3, 0.6, 1, 0.2, 3, 13, 0.2};
    const SortedFlock<double> sorted(flock, Reach(soft));
    ExpectSame(sorted.Sum(hard, "scalar"),
               BruteForce(sorted.bodies, MakeZonePairs<double>(hard, HardEdge{}), Anyone), 1e-12);
    ExpectSame(sorted.Sum(soft, "scalar"),
               BruteForce(sorted.bodies, MakeZonePairs<double>(soft, 0.2), Anyone), 1e-12);
  }
}

// The four terms of a shape-constrained swarm, each by itself.
struct TermsOfShape {
  ZonePairs<double, HardEdge> zones;
  ShapeForce::Params<double, HardEdge> spread;

  struct Sums {
    ZonePairs<double, HardEdge>::Sums zones;
    Weighted<double> spread;
    double Neighbours() const { return zones.Neighbours(); }
  };
  struct Said {
    decltype(std::declval<ZonePairs<double, HardEdge>>().Pair(Vec3d{}, Vec3d{})) zones;
    Share<double> spread;
    friend void operator+=(Sums& sums, const Said& said) {
      sums.zones += said.zones;
      sums.spread += said.spread;
    }
  };
  explicit TermsOfShape(const ShapePairNumbers& n)
      : zones(MakeZonePairs<double>({.r_rep = n.r_rep,
                                     .r_ali = n.r_ali,
                                     .r_att = n.r_att,
                                     .w_rep = n.w_rep,
                                     .w_ali = n.w_ali,
                                     .w_att = n.w_att},
                                    HardEdge{})),
        spread{n.w_con, n.reach, n.sigma, HardEdge{}} {}
  const TermsOfShape& For(const Vec3d& /*v*/) const { return *this; }
  Said Pair(const Vec3d& dx, const Vec3d& dv) const {
    return {zones.Pair(dx, dv), ShapeForce::Pair(spread, dx, dv)};
  }
  Vec3d Finish(const Sums& sums) const {
    return zones.Finish(sums.zones) + ShapeForce::Finish(spread, sums.spread);
  }
};

TEST(PairForces, ShapePairsAreBruteForce) {
  ShapeParameters p;
  p.r_ali = 0.7;
  for (const NamedFlock& flock : ManyFlocks()) {
    for (const double range : {0.2, 1.0, 5.0}) {
      SCOPED_TRACE(flock.name);
      const ShapePairNumbers n = MakeShapePairNumbers(p, 0.3, range);
      const SortedFlock<double> sorted(flock, Reach(n));
      ExpectSame(sorted.Sum(n, "scalar"), BruteForce(sorted.bodies, TermsOfShape(n), Anyone), 1e-9);
    }
  }
}

TEST(PairForces, OpenSteersRulesAreBruteForce) {
  for (const NamedFlock& plain : ManyFlocks()) {
    SCOPED_TRACE(plain.name);
    const NamedFlock flock = Headings(plain);
    const auto hard = SteerRules(1), soft = SteerRules(1, 0.2, 0.1);
    const SortedFlock<double> sorted(flock, Reach(soft));
    ExpectSame(
        sorted.Sum(hard, "scalar"),
        BruteForce(sorted.bodies, MakeSteerPairs<double>(hard, HardEdge{}, HardEdge{}), Anyone),
        1e-9);
    ExpectSame(sorted.Sum(soft, "scalar"),
               BruteForce(sorted.bodies, MakeSteerPairs<double>(soft, 0.2, 0.1), Anyone), 1e-9);
  }
}

// The rule that pair_forces.h states, spelled out.
TEST(PairForces, ASampleIsEveryStridethOfTheSort) {
  for (const NamedFlock& flock : ManyFlocks()) {
    SCOPED_TRACE(flock.name);
    const ZoneParameters p{0.3, 0.6, 1, 0.2, 3, 13, 0};
    const SortedFlock<double> sorted(flock, Reach(p), 10);
    const auto g = sorted.grid.view();
    std::vector<int> row_of(sorted.bodies.size());
    for (int row = 0; row < g.RowCount(); ++row) {
      const int b = 1 + row % g.ny, c = 1 + row / g.ny;
      for (auto k = g.start[g.Cell(1, b, c)]; k < g.start[g.Cell(g.nx, b, c) + 1]; ++k) {
        row_of[k] = row;
      }
    }
    const auto sampled = [&](std::size_t k, std::size_t j) {
      const RowSample& sample = sorted.rows[static_cast<std::size_t>(row_of[k])];
      return j % sample.stride == sample.phase;
    };
    ExpectSame(sorted.Sum(p, "scalar"),
               BruteForce(sorted.bodies, MakeZonePairs<double>(p, HardEdge{}), sampled), 1e-12);
  }
}

TEST(PairForces, ASampleLeavesAboutAsManyAsAsked) {
  const NamedFlock flock = RandomFlock("", 4000, {5, 5, 5}, 22);
  ZoneParameters p{0.3, 4, 20, 0.2, 3, 13, 0};  // everybody sees everybody
  EXPECT_EQ(Mean(SortedFlock<float>(flock, Reach(p)).Sum(p, "").neighbours), 3999);
  for (const std::uint32_t most : {20U, 100U}) {
    const double mean = Mean(SortedFlock<float>(flock, Reach(p), most).Sum(p, "").neighbours);
    EXPECT_NEAR(mean, most, 0.1 * most);
  }
}

// Over many steps the sample's mean force is the force.
TEST(PairForces, ASampleIsUnbiased) {
  const NamedFlock flock = RandomFlock("", 400, {5, 5, 5}, 23);
  const ZoneParameters p{0.3, 4, 20, 0.2, 3, 13, 0};
  SortedFlock<double> sorted(flock, Reach(p));
  const ByAnimal all = sorted.Sum(p, "scalar");
  std::vector<Vec3d> mean(400);
  const int steps = 400;
  for (int step = 0; step < steps; ++step) {
    SampleRows(sorted.grid, 40, static_cast<std::uint32_t>(step), &sorted.rows);
    const ByAnimal sampled = sorted.Sum(p, "scalar");
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += sampled.acceleration[k] / steps;
  }
  double error = 0, size = 0;
  for (std::size_t k = 0; k < mean.size(); ++k) {
    error += Norm(mean[k] - all.acceleration[k]);
    size += Norm(all.acceleration[k]);
  }
  EXPECT_LT(error, 0.1 * size);
}

TEST(PairForces, NearestIsBruteForce) {
  for (const NamedFlock& flock : ManyFlocks()) {
    if (flock.name == "lattice" || flock.name == "all in one place") continue;  // ties
    SCOPED_TRACE(flock.name);
    SortedFlock<double> sorted(flock, 1);
    ThreadPool pool(2);
    sorted.nearest = FindNearest(sorted.bodies, 7, &pool);
    const auto squared = [&](std::size_t k, std::size_t j) {
      return SquaredNorm(sorted.bodies.Position(j) - sorted.bodies.Position(k));
    };
    std::vector<double> seventh;  // nearest of each animal, itself being the 0th
    for (std::size_t k = 0; k < sorted.bodies.size(); ++k) {
      std::vector<double> all;
      for (std::size_t j = 0; j < sorted.bodies.size(); ++j) all.push_back(squared(k, j));
      std::sort(all.begin(), all.end());
      seventh.push_back(all[std::min<std::size_t>(7, all.size() - 1)]);
    }
    const auto nearest = [&](std::size_t k, std::size_t j) { return squared(k, j) <= seventh[k]; };
    BoidsParameters<double> p = PlainRules(0.4, 1e9), blind = BlindRules(2.0);
    ExpectSame(sorted.Sum(p, "scalar"),
               BruteForce(sorted.bodies, MakeBoidsPairs<double>(p, HardEdge{}), nearest), 1e-12);
    p.d_v = 0.1;  // does not count
    for (const double neighbours : sorted.Sum(p, "scalar").neighbours) {
      EXPECT_EQ(neighbours, std::min<double>(7, static_cast<double>(sorted.bodies.size()) - 1));
    }
    blind.d_v = 1e9;
    const ViewCone<double, HardEdge> view{{}, SightCosine(2.0), {}};
    ExpectSame(sorted.Sum(blind, "scalar"),
               BruteForce(sorted.bodies, MakeBoidsPairs<double>(blind, HardEdge{}, view), nearest),
               1e-12);
    const ZoneParameters zones{0.3, 0.6, 1, 0.2, 3, 13, 0};
    ExpectSame(sorted.Sum(zones, "scalar"),
               BruteForce(sorted.bodies, MakeZonePairs<double>(zones, HardEdge{}), nearest), 1e-12);
  }
}

TEST(PairForces, ThreadsChangeNothing) {
  const NamedFlock flock = RandomFlock("", 3000, {8, 8, 8}, 24);
  const ZoneParameters zones{0.3, 0.6, 1, 0.2, 3, 13, 0};
  for (const std::uint32_t most : {0U, 12U}) {
    const SortedFlock<float> sorted(flock, 1.2, most);
    for (const char* kernel : {"scalar", ""}) {
      EXPECT_EQ(sorted.Sum(zones, kernel, 1), sorted.Sum(zones, kernel, 2));
      EXPECT_EQ(sorted.Sum(PlainRules(0.4, 1.05), kernel, 1),
                sorted.Sum(PlainRules(0.4, 1.05), kernel, 2));
    }
  }
}

}  // namespace
}  // namespace flocklift
