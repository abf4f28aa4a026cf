// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/flock_morph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <tuple>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

// A cloud of small tetrahedra of random shapes in a box about a point.
std::vector<Tetra> Cloud(int count, const Vec3d& centre, const Vec3d& half, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Tetra> cloud;
  while (static_cast<int>(cloud.size()) < count) {
    const Vec3d p = centre + Vec3d{half.x * rng.Uniform(-1, 1), half.y * rng.Uniform(-1, 1),
                                   half.z * rng.Uniform(-1, 1)};
    Tetra t;
    for (Vec3d& corner : t) corner = p + 0.1 * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
    if (Volume(t) < 0) std::swap(t[0], t[1]);
    if (ShapeQuality(t) > 0.1) cloud.push_back(t);
  }
  return cloud;
}

std::vector<Vec3d> Straight(const Vec3d& from, const Vec3d& to, int points) {
  std::vector<Vec3d> path;
  for (int k = 0; k < points; ++k) path.push_back(from + k / (points - 1.0) * (to - from));
  return path;
}

MorphScene Scene(int count) {
  MorphScene scene;
  scene.from = Cloud(count, {0, 0, 0}, {1, 1, 1}, 1);
  scene.to = Cloud(count, {20, 0, 0}, {1, 3, 0.5}, 2);
  scene.path = Straight({0, 0, 0}, {20, 0, 0}, 40);
  scene.options.departure_time = 1;
  return scene;
}

ScalarField BallField(const Vec3d& centre, double radius, const Vec3d& low, const Vec3d& high) {
  ScalarField field{GridOver(low, high, 0.1), {}};
  for (std::size_t k = 0; k < field.grid.size(); ++k) {
    field.values.push_back(static_cast<float>(Norm(field.grid.Node(k) - centre) - radius));
  }
  return field;
}

void RunToTheEnd(FlockMorph* morph, ThreadPool* pool, int most_steps = 3000) {
  for (int k = 0; k < most_steps && !morph->Done(); ++k) morph->Step(pool);
  ASSERT_TRUE(morph->Done());
}

Vec3d ToDouble(const Vec3<float>& p) { return {p.x, p.y, p.z}; }

TEST(FlockMorph, StartsAsTheSourceAndEndsAsTheTarget) {
  ThreadPool pool(1);
  const MorphScene scene = Scene(200);
  FlockMorph morph(scene);
  for (std::size_t k = 0; k < morph.size(); ++k) {
    for (int c = 0; c < 4; ++c) {
      EXPECT_LT(Norm(ToDouble(morph.Vertex(k, c)) - scene.from[k][static_cast<std::size_t>(c)]),
                1e-5);
    }
  }
  RunToTheEnd(&morph, &pool);
  std::set<std::uint32_t> used;
  for (std::size_t k = 0; k < morph.size(); ++k) {
    used.insert(morph.TargetOf(k));
    const Tetra& target = scene.to[morph.TargetOf(k)];
    EXPECT_LT(Norm(morph.Position(k) - Centroid(target)), 1e-5);
    for (int c = 0; c < 4; ++c) {  // the corners in some order
      double nearest = 1;
      for (const Vec3d& corner : target) {
        nearest = std::min(nearest, Norm(ToDouble(morph.Vertex(k, c)) - corner));
      }
      EXPECT_LT(nearest, 2e-6);  // float's grain at 20 m
    }
  }
  EXPECT_EQ(used.size(), morph.size());
}

TEST(FlockMorph, LeavesInTheOrderOfD1AndFillsInTheOrderOfD2) {
  const MorphScene scene = Scene(50);
  const FlockMorph morph(scene);
  for (std::size_t a = 0; a < morph.size(); ++a) {
    for (std::size_t b = 0; b < morph.size(); ++b) {
      if (morph.RankOf(a) >= morph.RankOf(b)) continue;
      EXPECT_GE(Centroid(scene.from[a]).x, Centroid(scene.from[b]).x);
      EXPECT_GE(Centroid(scene.to[morph.TargetOf(a)]).x, Centroid(scene.to[morph.TargetOf(b)]).x);
    }
  }
}

// Phase 1 flies at omega1 speed0 along the path, phase 2 at speed0 in a straight line and is there
// at the first step not before t_f.
TEST(FlockMorph, TheFlightOfOneByHand) {
  ThreadPool pool(1);
  MorphScene scene = Scene(1);
  scene.options.omega1 = 0.5;
  scene.options.region = RegionKind::kSphere;
  FlockMorph morph(scene);
  const TargetRegion region(RegionKind::kSphere, scene.to, 1);
  const double speed0 = scene.options.speed0;
  Vec3d last = morph.Position(0);
  while (morph.Progress(0) < 0) {
    morph.Step(&pool);
    EXPECT_NEAR(Norm(morph.Position(0) - last), 0.5 * speed0 * scene.dt, 1e-5);
    EXPECT_NEAR(morph.Position(0).y, last.y, 1e-6);
    EXPECT_EQ(morph.Progress(0) >= 0,
              region.Contains(morph.Position(0)) || morph.Position(0).x > scene.path.back().x);
    last = morph.Position(0);
  }
  const Vec3d entered = last, place = Centroid(scene.to[0]);
  const double t_f = Norm(place - entered) / speed0;
  int steps = 0;
  for (; morph.Progress(0) < 1; ++steps) {
    morph.Step(&pool);
    const double share = std::min(1.0, (steps + 1) * scene.dt / t_f);
    EXPECT_LT(Norm(morph.Position(0) - (entered + share * (place - entered))), 1e-4);
    EXPECT_NEAR(morph.Progress(0), share, 1e-3);
  }
  EXPECT_EQ(steps, static_cast<int>(std::ceil(t_f / scene.dt)));
}

TEST(FlockMorph, InFlightTetrahedraAreShrunken) {
  ThreadPool pool(1);
  MorphScene scene = Scene(30);
  scene.options.departure_time = 0;
  FlockMorph morph(scene);
  while (morph.time() < 0.6) morph.Step(&pool);
  morph.UpdateVertices(&pool);
  for (std::size_t k = 0; k < morph.size(); ++k) {
    ASSERT_LT(morph.Progress(k), 0);
    Tetra t;
    for (int c = 0; c < 4; ++c) t[static_cast<std::size_t>(c)] = ToDouble(morph.Vertex(k, c));
    EXPECT_NEAR(Volume(t) / Volume(scene.from[k]), 1.0 / 8, 0.01);
  }
}

// The kernels' float shapes against the reference in double.
TEST(FlockMorph, ShapesBetweenAreThoseOfTheMorph) {
  ThreadPool pool(1);
  for (const MorphKind kind : {MorphKind::kPublished, MorphKind::kShoemake}) {
    MorphScene scene = Scene(40);
    scene.options.departure_time = 0;
    scene.options.kind = kind;
    scene.options.match_corners = false;
    scene.options.shrink = 1;
    scene.options.morph_share = 0.5;
    FlockMorph morph(scene);
    int compared = 0;
    for (int step = 0; step < 1000 && !morph.Done(); ++step) {
      morph.Step(&pool);
      morph.UpdateVertices(&pool);
      for (std::size_t k = 0; k < morph.size(); ++k) {
        const double progress = morph.Progress(k);
        if (progress <= 0 || progress >= 1) continue;
        ++compared;
        const double s = std::min(1.0, progress / 0.5), t = s * s * (3 - 2 * s);
        const Tetra &from = scene.from[k], &to = scene.to[morph.TargetOf(k)];
        const glm::dmat3 a = TetraMorph(from, to).At(t, kind);
        for (int c = 0; c < 4; ++c) {
          const Vec3d offset = from[static_cast<std::size_t>(c)] - Centroid(from);
          const glm::dvec3 moved = a * glm::dvec3(offset.x, offset.y, offset.z);
          const Vec3d expected = morph.Position(k) + Vec3d{moved.x, moved.y, moved.z};
          EXPECT_LT(Norm(ToDouble(morph.Vertex(k, c)) - expected), 2e-5);
        }
      }
    }
    EXPECT_GT(compared, 100);
  }
}

// The direction of the key point that is nearest, by brute force over all of them.
TEST(FlockMorph, FollowsTheNearestKeyPoint) {
  ThreadPool pool(1);
  MorphScene scene = Scene(60);
  scene.path.clear();
  for (int k = 0; k <= 80; ++k) {
    scene.path.push_back({k * 0.25, 3 * std::sin(k * std::numbers::pi / 40), 0});
  }
  scene.options.departure_time = 0;
  scene.options.region = RegionKind::kSphere;
  FlockMorph morph(scene);
  int agree = 0, all = 0;
  for (int step = 0; step < 100; ++step) {
    std::vector<Vec3d> before;
    for (std::size_t k = 0; k < morph.size(); ++k) before.push_back(morph.Position(k));
    morph.Step(&pool);
    for (std::size_t k = 0; k < morph.size(); ++k) {
      if (morph.Progress(k) != kFollows) continue;
      std::size_t nearest = 0;
      for (std::size_t q = 1; q + 1 < scene.path.size(); ++q) {
        if (Norm(scene.path[q] - before[k]) < Norm(scene.path[nearest] - before[k])) nearest = q;
      }
      const Vec3d way = Normalized(scene.path[nearest + 1] - scene.path[nearest]);
      ++all;
      agree += Norm(morph.Velocity(k) - scene.options.speed0 * way) < 1e-3 ? 1 : 0;
    }
  }
  EXPECT_GT(all, 1000);
  EXPECT_GT(agree, 0.97 * all);  // but for ties, and those far off the path
}

// A figure of eight: at its crossing the nearest key point may belong to the other loop.
TEST(FlockMorph, APathMayCrossItself) {
  ThreadPool pool(1);
  MorphScene scene = Scene(50);
  scene.from = Cloud(50, {0, 0, 0}, {0.2, 0.2, 0.2}, 1);
  scene.to = Cloud(50, {0, 0, 12}, {0.2, 0.2, 0.2}, 2);
  scene.path.clear();
  double length = 0;
  for (int k = 0; k <= 400; ++k) {  // round about, rising only at the end
    const double phase = k * 2 * std::numbers::pi / 400;
    scene.path.push_back(
        {10 * std::sin(phase), 5 * std::sin(2 * phase), k < 360 ? 0 : (k - 360) * 0.3});
    if (k > 0)
      length += Norm(scene.path[static_cast<std::size_t>(k)] -
                     scene.path[static_cast<std::size_t>(k) - 1]);
  }
  scene.options.departure_time = 0;
  FlockMorph morph(scene);
  double farthest_left = 0, farthest_right = 0;
  while (!morph.Done() && morph.time() < 60) {
    morph.Step(&pool);
    farthest_left = std::min(farthest_left, morph.Position(0).x);
    farthest_right = std::max(farthest_right, morph.Position(0).x);
  }
  ASSERT_TRUE(morph.Done());
  EXPECT_GT(farthest_right, 8);  // both loops were flown
  EXPECT_LT(farthest_left, -8);
  EXPECT_NEAR(morph.time(), length / scene.options.speed0, 0.2 * length / scene.options.speed0);
}

TEST(FlockMorph, WhoMissesTheRegionTurnsAtTheEndOfThePath) {
  ThreadPool pool(1);
  MorphScene scene = Scene(100);
  scene.to = Cloud(100, {20, 9, 0}, {0.5, 0.5, 0.5}, 3);  // the path passes it by
  FlockMorph morph(scene);
  RunToTheEnd(&morph, &pool);
}

// ---- obstacles --------------------------------------------------------------------------------

double DeepestInside(const MorphScene& scene, const Vec3d& centre, double radius) {
  ThreadPool pool(1);
  FlockMorph morph(scene);
  double deepest = 0;
  while (!morph.Done() && morph.time() < 30) {
    morph.Step(&pool);
    for (std::size_t k = 0; k < morph.size(); ++k) {
      deepest = std::max(deepest, radius - Norm(morph.Position(k) - centre));
    }
  }
  EXPECT_TRUE(morph.Done());
  return deepest;
}

TEST(FlockMorph, FliesAroundAnObstacleOnThePath) {
  MorphScene scene = Scene(300);
  const Vec3d centre{10, 0.1, 0};
  EXPECT_GT(DeepestInside(scene, centre, 1.5), 1);
  scene.obstacles = BallField(centre, 1.5, {6, -4, -4}, {14, 4, 4});
  scene.options.k_a = 0.5;
  EXPECT_LT(DeepestInside(scene, centre, 1.5), 0.02);
}

// Within the target's bounding sphere: the paper's flock goes straight through there.
TEST(FlockMorph, FliesAroundAnObstacleInTheTargetRegion) {
  MorphScene scene = Scene(300);
  scene.to = Cloud(300, {20, 0, 0}, {0.5, 5, 0.5}, 4);
  scene.options.region = RegionKind::kSphere;
  scene.options.k_a = 0.3;
  const Vec3d centre{18, 1, 0};  // 2 m in front of the target
  scene.obstacles = BallField(centre, 1, {14, -4, -4}, {22, 6, 4});
  scene.options.avoid_near_target = false;
  EXPECT_GT(DeepestInside(scene, centre, 1), 0.3);
  scene.options.avoid_near_target = true;
  EXPECT_LT(DeepestInside(scene, centre, 1), 0.02);
}

// ---- minimum distance -------------------------------------------------------------------------

std::pair<double, double> ShareTooNear(MorphScene scene) {  // in phase 1, in phase 2
  ThreadPool pool(1);
  FlockMorph morph(scene);
  double near[2] = {}, all[2] = {};
  for (int step = 0; !morph.Done() && step < 2000; ++step) {
    morph.Step(&pool);
    if (step % 10 != 0) continue;
    for (std::size_t a = 0; a < morph.size(); ++a) {
      const float progress = morph.Progress(a);
      if (progress == kWaits || progress > 0.5F) continue;
      const std::size_t phase = progress >= 0 ? 1 : 0;
      ++all[phase];
      for (std::size_t b = 0; b < morph.size(); ++b) {
        if (b == a || morph.Progress(b) == kWaits || morph.Progress(b) > 0.5F) continue;
        if (Norm(morph.Position(a) - morph.Position(b)) < 0.06) {
          ++near[phase];
          break;
        }
      }
    }
  }
  EXPECT_TRUE(morph.Done());
  return {near[0] / all[0], near[1] / all[1]};
}

TEST(FlockMorph, KeepsItsDistanceOnTheWayAndNearTheTarget) {
  MorphScene scene = Scene(400);
  const auto [free1, free2] = ShareTooNear(scene);
  scene.options.d_min = 0.12;
  const auto [kept1, kept2] = ShareTooNear(scene);
  scene.options.space_near_target = false;
  const auto [paper1, paper2] = ShareTooNear(scene);
  EXPECT_LT(kept1, 0.2 * free1);
  EXPECT_LT(paper1, 0.2 * free1);
  EXPECT_LT(kept2, 0.7 * paper2);
}

// ---- styles -----------------------------------------------------------------------------------

TEST(FlockMorph, StylesMoveTheFlockAndItArrives) {
  for (const MorphStyle style : {MorphStyle::kCurl, MorphStyle::kWind, MorphStyle::kGravity}) {
    ThreadPool pool(1);
    MorphScene scene = Scene(100);
    scene.options.style = style;
    scene.options.omega1 = 0.7;
    scene.options.omega2 = 0.3;
    scene.options.wind = {0, 1, 0};
    scene.options.wind_speed = 3;
    scene.options.width = 2;
    MorphScene plain = scene;
    plain.options.omega2 = 0;
    FlockMorph styled(scene), straight(plain);
    while (styled.time() < 2) {
      styled.Step(&pool);
      straight.Step(&pool);
    }
    double apart = 0;
    for (std::size_t k = 0; k < styled.size(); ++k) {
      apart += Norm(styled.Position(k) - straight.Position(k)) / 100;
    }
    EXPECT_GT(apart, 0.05);
    RunToTheEnd(&styled, &pool);
  }
}

TEST(FlockMorph, ThePathsWidthHoldsTheFlockTogether) {
  const auto farthest = [](double width) {
    ThreadPool pool(1);
    MorphScene scene = Scene(100);
    scene.options.style = MorphStyle::kWind;
    scene.options.omega2 = 1;
    scene.options.wind = {0, 1, 0};
    scene.options.wind_speed = 4;
    scene.options.width = width;
    scene.options.departure_time = 0;
    FlockMorph morph(scene);
    double far = 0;
    while (morph.time() < 1.5) {
      morph.Step(&pool);
      for (std::size_t k = 0; k < morph.size(); ++k) {
        far = std::max(far, std::abs(morph.Position(k).y));
      }
    }
    return far;
  };
  EXPECT_LT(farthest(1), 0.6 * farthest(0));
}

// ---- the same bytes ---------------------------------------------------------------------------

using Bytes = std::vector<Vec3<float>>;
Bytes Flight(int threads, const std::string& kernel) {
  ThreadPool pool(threads);
  MorphScene scene = Scene(5000);
  scene.options.style = MorphStyle::kWind;
  scene.options.omega2 = 0.3;
  scene.options.width = 1;
  scene.options.d_min = 0.05;
  scene.obstacles = BallField({10, 0, 0}, 1, {7, -3, -3}, {13, 3, 3});
  FlockMorph morph(scene, kernel);
  Bytes bytes;
  for (int step = 0; step < 170; ++step) morph.Step(&pool);
  morph.UpdateVertices(&pool);
  for (std::size_t k = 0; k < morph.size(); ++k) {
    for (int c = 0; c < 4; ++c) bytes.push_back(morph.Vertex(k, c));
  }
  return bytes;
}

TEST(FlockMorph, SameBytesWithOneAndTwoThreads) { EXPECT_EQ(Flight(1, ""), Flight(2, "")); }

TEST(FlockMorph, SameBytesWithEveryKernelOfThisMachine) {
  const Bytes first = Flight(1, kMorphKernels[0].name);
  for (const MorphKernelVariant& variant : kMorphKernels) {
    if (!variant.supported()) continue;
    EXPECT_EQ(Flight(1, variant.name), first) << variant.name;
  }
}

TEST(FlockMorph, RefusesWhatMakesNoSense) {
  MorphScene scene = Scene(5);
  scene.to.pop_back();
  EXPECT_THROW(FlockMorph{scene}, std::invalid_argument);
  scene = Scene(5);
  scene.path = {{1, 1, 1}, {1, 1, 1}};
  EXPECT_THROW(FlockMorph{scene}, std::invalid_argument);
  scene = Scene(5);
  scene.options.shrink = 0;
  EXPECT_THROW(FlockMorph{scene}, std::invalid_argument);
  EXPECT_THROW(FlockMorph(Scene(5), "none such"), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
