// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/orca.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "simulate/core/rng.h"
#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

Vec3d RandomVector(Rng* rng, double scale) {
  return scale * Vec3d{rng->Normal(), rng->Normal(), rng->Normal()};
}
double Lack(const std::vector<HalfSpace>& allowed, const Vec3d& v) {
  double worst = 0;
  for (const HalfSpace& h : allowed) worst = std::max(worst, Dot(h.normal, h.point - v));
  return worst;
}

// Whether A at 0 and B at dx collide within the horizon at the relative velocity v.
bool Collides(const Vec3d& dx, const Vec3d& v, double radii, double horizon) {
  const double time = std::clamp(Dot(dx, v) / std::max(Dot(v, v), 1e-300), 0.0, horizon);
  return Norm(dx - time * v) < radii;
}

// ---- the half-space of a pair ------------------------------------------------------------------

TEST(Orca, HeadOnByHand) {
  // 2 m/s towards a body of radius 1 at rest 3 m away, within 1 s: the tip of the cone is a ball of
  // radius 1 about (3, 0, 0). 1.5 of the 2 m/s is safe by half a metre; so half of it may be added.
  const HalfSpace h = AvoidPair({3, 0, 0}, {1.5, 0, 0}, {}, 1, 1, 0.1);
  EXPECT_NEAR(h.normal.x, -1, 1e-12);
  EXPECT_NEAR(h.point.x, 1.75, 1e-12);
  // Overlapping by half: apart within the step of 0.1 s, each 2.5 m/s of the 5.
  const HalfSpace apart = AvoidPair({0.5, 0, 0}, {}, {}, 1, 1, 0.1);
  EXPECT_NEAR(apart.normal.x, -1, 1e-12);
  EXPECT_NEAR(apart.point.x, -2.5, 1e-12);
}

// u ends on the surface of what collides, and no other way to the surface is shorter.
TEST(Orca, TheWayOutIsTheShortest) {
  Rng rng(3);
  int inside = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const Vec3d dx = 2.5 * Normalized(RandomVector(&rng, 1));
    const Vec3d v_a = RandomVector(&rng, 1), v_b = RandomVector(&rng, 1);
    const double radii = 1, horizon = 1.5;
    const Vec3d v = v_a - v_b;
    const HalfSpace h = AvoidPair(dx, v_a, v_b, radii, horizon, 0.1);
    const Vec3d u = 2 * (h.point - v_a);
    EXPECT_NEAR(Norm(h.normal), 1, 1e-12);
    EXPECT_NEAR(Norm(Cross(u, h.normal)), 0, 1e-9);
    const bool collides = Collides(dx, v, radii, horizon);
    inside += collides;
    EXPECT_EQ(Dot(u, h.normal) > 0, collides);
    EXPECT_FALSE(Collides(dx, v + u + 1e-6 * h.normal, radii, horizon));
    EXPECT_TRUE(Collides(dx, v + u - 1e-6 * h.normal, radii, horizon));
    for (int k = 0; k < 50; ++k) {
      const Vec3d other = 0.999 * Norm(u) * Normalized(RandomVector(&rng, 1));
      EXPECT_EQ(Collides(dx, v + other, radii, horizon), collides);
    }
  }
  EXPECT_GT(inside, 20);
}

TEST(Orca, BothTakeTheSameHalf) {
  Rng rng(4);
  for (int trial = 0; trial < 100; ++trial) {
    Vec3d dx = RandomVector(&rng, 2), v_a = RandomVector(&rng, 1), v_b = RandomVector(&rng, 1);
    if (trial % 3 == 0) v_a = 0.7 * dx, v_b = -0.4 * dx;  // straight at each other
    const HalfSpace a = AvoidPair(dx, v_a, v_b, 1, 2, 0.1);
    const HalfSpace b = AvoidPair(-dx, v_b, v_a, 1, 2, 0.1);
    EXPECT_LT(Norm(a.normal + b.normal), 1e-9);
    EXPECT_LT(Norm((a.point - v_a) + (b.point - v_b)), 1e-9);
  }
}

// ---- the programme -----------------------------------------------------------------------------

// The nearest point by trying every set of at most three active planes, with and without the
// sphere.
std::optional<Vec3d> NearestByEnumeration(const std::vector<HalfSpace>& allowed,
                                          const Vec3d& target, double max_speed) {
  std::vector<Vec3d> candidates = {target, max_speed * Normalized(target)};
  const auto n = allowed.size();
  // On the affine set of the planes: nearest to the target, and nearest on the sphere's section.
  const auto add = [&](const Vec3d& nearest, const Vec3d& centre) {
    candidates.push_back(nearest);
    const double squared = max_speed * max_speed - SquaredNorm(centre);
    if (squared >= 0) {
      candidates.push_back(centre + std::sqrt(squared) * Normalized(nearest - centre));
    }
  };
  for (std::size_t a = 0; a < n; ++a) {
    const HalfSpace& p = allowed[a];
    add(target + Dot(p.point - target, p.normal) * p.normal, Dot(p.point, p.normal) * p.normal);
    for (std::size_t b = 0; b < a; ++b) {
      const HalfSpace& q = allowed[b];
      const Vec3d line = Cross(p.normal, q.normal);
      const double squared = SquaredNorm(line);
      if (squared < 1e-12) continue;
      const double hp = Dot(p.point, p.normal), hq = Dot(q.point, q.normal);
      const Vec3d origin = Cross(line, hp * q.normal - hq * p.normal) / -squared;  // nearest to 0
      const Vec3d unit = line / std::sqrt(squared);
      add(origin + Dot(target - origin, unit) * unit, origin);
      for (std::size_t c = 0; c < b; ++c) {
        const double slope = Dot(unit, allowed[c].normal);
        if (std::abs(slope) < 1e-9) continue;
        candidates.push_back(origin +
                             (Dot(allowed[c].point - origin, allowed[c].normal) / slope) * unit);
      }
    }
  }
  std::optional<Vec3d> best;
  for (const Vec3d& v : candidates) {
    if (Norm(v) > max_speed * (1 + 1e-9) || Lack(allowed, v) > 1e-7) continue;
    if (!best || Norm(v - target) < Norm(*best - target)) best = v;
  }
  return best;
}

std::vector<HalfSpace> RandomHalfSpaces(Rng* rng, int count, double away) {
  std::vector<HalfSpace> allowed;
  for (int k = 0; k < count; ++k) {
    const Vec3d normal = Normalized(RandomVector(rng, 1));
    allowed.push_back(
        {rng->Uniform(-away, 0.4 * away) * normal + Cross(normal, {1, 2, 3}), normal});
  }
  return allowed;
}

TEST(Orca, NearestVelocityIsTheNearest) {
  Rng rng(5);
  std::vector<HalfSpace> room;
  int solved = 0, moved = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const auto allowed = RandomHalfSpaces(&rng, trial % 7, 1.0);
    const Vec3d target = RandomVector(&rng, 1);
    const auto expected = NearestByEnumeration(allowed, target, 1.5);
    if (!expected) continue;
    ++solved;
    const Vec3d actual = NearestVelocity(allowed, target, 1.5, &room);
    EXPECT_LE(Norm(actual), 1.5 + 1e-9);
    EXPECT_LT(Lack(allowed, actual), 1e-7);
    EXPECT_NEAR(Norm(actual - target), Norm(*expected - target), 1e-6) << trial;
    moved += Norm(actual - target) > 1e-3;
  }
  EXPECT_GT(solved, 1000);
  EXPECT_GT(moved, 500);
}

// Where nothing satisfies all: nobody violates the worst less.
TEST(Orca, WithoutASolutionTheWorstIsLeastViolated) {
  Rng rng(6);
  std::vector<HalfSpace> room;
  int impossible = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<HalfSpace> allowed = RandomHalfSpaces(&rng, 6, 0.3);
    for (HalfSpace& h : allowed) h.point += 0.8 * h.normal;
    const Vec3d target = RandomVector(&rng, 1);
    if (NearestByEnumeration(allowed, target, 1)) continue;
    ++impossible;
    const Vec3d actual = NearestVelocity(allowed, target, 1, &room);
    EXPECT_LE(Norm(actual), 1 + 1e-9);
    const double worst = Lack(allowed, actual);
    // A search from that point on, ever finer, finds nothing better.
    Vec3d best = actual;
    for (double step = 0.5; step > 1e-4; step *= 0.8) {
      for (int k = 0; k < 40; ++k) {
        Vec3d v = best + RandomVector(&rng, step);
        if (Norm(v) > 1) v = Normalized(v);
        if (Lack(allowed, v) < Lack(allowed, best)) best = v;
      }
    }
    EXPECT_GT(Lack(allowed, best), worst - 1e-6) << trial;
  }
  EXPECT_GT(impossible, 100);
}

// ---- swarms ------------------------------------------------------------------------------------

struct Flight {
  double least_distance = 1e9;  // of any two bodies, over the radii's sum
  Bodies<double> last;          // in the order of the last sort
};

// Everybody prefers to fly straight to a goal of its own.
Flight Fly(const NamedFlock& start, const std::vector<Vec3d>& goals, double radius, int steps,
           int threads = 1, const AddWalls& walls = {}) {
  const double dt = 0.05;
  const OrcaOptions options{.horizon = 2, .max_speed = 1, .sight = 5, .most_neighbours = 24};
  Bodies<double> now = AsBodies<double>(start), sorted;
  const std::vector<double> radii(now.size(), radius);
  CellGrid<double> grid;
  ThreadPool pool(threads);
  std::vector<Vec3d> velocities(now.size());
  Flight flight;
  for (int step = 0; step < steps; ++step) {
    grid.Sort(now, options.sight, &sorted);
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      const Vec3d way = goals[sorted.agent[k]] - sorted.Position(k);
      velocities[k] = std::min(0.8, Norm(way) / dt) * Normalized(way);
    }
    AvoidCollisions(options, dt, grid, sorted, radii, walls, &pool, &velocities);
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      sorted.Set(k, sorted.Position(k) + dt * velocities[k], velocities[k]);
    }
    std::swap(now, sorted);
    for (std::size_t k = 0; k < now.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        flight.least_distance =
            std::min(flight.least_distance, Norm(now.Position(k) - now.Position(j)) / (2 * radius));
      }
    }
  }
  flight.last = now;
  return flight;
}

TEST(Orca, TwoThatMeetExactlyHeadOnStop) {
  const NamedFlock start{"", {{-4, 0, 0}, {4, 0, 0}}, {{0.8, 0, 0}, {-0.8, 0, 0}}};
  const Flight flight = Fly(start, {{4, 0, 0}, {-4, 0, 0}}, 0.5, 400);
  EXPECT_GE(flight.least_distance, 1 - 1e-9);
}

TEST(Orca, TwoThatMeetNearlyHeadOnPassEachOther) {
  const NamedFlock start{"", {{-4, 0, 0}, {4, 0.02, 0.01}}, {{0.8, 0, 0}, {-0.8, 0, 0}}};
  const Flight flight = Fly(start, {{4, 0, 0}, {-4, 0, 0}}, 0.5, 400);
  EXPECT_GE(flight.least_distance, 1 - 1e-9);
  EXPECT_LT(flight.least_distance, 1.3);  // and no detour
  for (std::size_t k = 0; k < 2; ++k) {
    const double side = flight.last.agent[k] == 0 ? 4 : -4;
    EXPECT_LT(Norm(flight.last.Position(k) - Vec3d{side, 0, 0}), 0.1);
  }
}

TEST(Orca, ASwarmThatChangesPlacesKeepsItsDistance) {
  Rng rng(7);
  NamedFlock start{"", {}, {}};
  std::vector<Vec3d> goals;
  for (int k = 0; k < 60; ++k) {  // from a sphere to its other side
    const Vec3d unit = Normalized(RandomVector(&rng, 1));
    start.position.push_back(6 * unit);
    start.velocity.push_back({});
    goals.push_back(-6 * unit);
  }
  for (std::size_t k = 0; k < 60; ++k) {  // no two begin too near
    for (std::size_t j = 0; j < k; ++j) {
      if (Norm(start.position[k] - start.position[j]) < 0.5) start.position[k] *= 1.3;
    }
  }
  const Flight flight = Fly(start, goals, 0.2, 500);
  EXPECT_GT(flight.least_distance, 0.98);
  double far = 0;
  for (std::size_t k = 0; k < 60; ++k) {
    far = std::max(far, Norm(flight.last.Position(k) - goals[flight.last.agent[k]]));
  }
  EXPECT_LT(far, 0.5);
}

TEST(Orca, AWallIsNotCrossed) {
  EXPECT_NEAR(AvoidWall({0, 0, 1}, 3, 1, 2).point.z, -1, 1e-12);  // 2 m in 2 s
  // Thirty that want to go through the plane x = 3 to the same place.
  const NamedFlock start = RandomFlock("", 30, {2, 8, 8}, 9);
  std::vector<Vec3d> goals(30, Vec3d{8, 4, 4});
  const double dt = 0.05;
  const OrcaOptions options{.horizon = 2, .max_speed = 1, .sight = 5, .most_neighbours = 24};
  Bodies<double> now = AsBodies<double>(start), sorted;
  CellGrid<double> grid;
  ThreadPool pool(1);
  std::vector<Vec3d> velocities(30);
  for (int step = 0; step < 200; ++step) {
    grid.Sort(now, options.sight, &sorted);
    for (std::size_t k = 0; k < 30; ++k) velocities[k] = Normalized(goals[k] - sorted.Position(k));
    AvoidCollisions(
        options, dt, grid, sorted, std::vector<double>(30, 0.1),
        [&](std::size_t k, std::vector<HalfSpace>* allowed) {
          allowed->push_back(AvoidWall({-1, 0, 0}, 3 - sorted.x[k], 0.1, options.horizon));
        },
        &pool, &velocities);
    for (std::size_t k = 0; k < 30; ++k) {
      sorted.Set(k, sorted.Position(k) + dt * velocities[k], velocities[k]);
      EXPECT_LT(sorted.x[k], 2.9 + 1e-6);
    }
    std::swap(now, sorted);
  }
}

TEST(Orca, ThreadsChangeNothing) {
  const NamedFlock start = RandomFlock("", 300, {14, 14, 14}, 8);
  const std::vector<Vec3d> goals(300, Vec3d{7, 7, 7});
  const Flight one = Fly(start, goals, 0.2, 20, 1), two = Fly(start, goals, 0.2, 20, 2);
  EXPECT_EQ(one.last.x, two.last.x);
  EXPECT_EQ(one.last.vz, two.last.vz);
}

}  // namespace
}  // namespace flocklift
