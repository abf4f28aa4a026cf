// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/cobyla.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flocklift {
namespace {

using internal::LinAnimal;
using internal::LinObjective;

CobylaOptions ByHand() {
  CobylaOptions options;
  options.lambda_t = 2;
  options.lambda_f = 0.5;
  options.lambda_sep = 0.25;
  options.lambda_speed = 30;
  options.near = 1;
  options.far = 100;
  options.d_sep = 5;
  return options;
}

// Two animals on the optical axis and beside it. In frame f-1 they were at (0, 0, 10) and
// (3, 0, 14), 5 m apart; a frame before that 1 m and 2 m nearer along z.
std::vector<LinAnimal> TwoAnimals() {
  return {{{0, 0, 1}, 2, {0, 0, 10}, {0, 0, 9}}, {{0.25, 0, 1}, 2, {3, 0, 14}, {3, 0, 12}}};
}

// Depths 12 and 16: positions (0, 0, 12) and (4, 0, 16).
//   displacements 2 and sqrt(1 + 4) against 1 and 2 a frame before
//   separation: unit offsets (-0.6, 0, -0.8) and (0.6, 0, 0.8); cohesion: (3, 0, 4) and (-3, 0, -4)
//   targets: (0, 0, 10) + 0.25 (-0.6, 0, -0.8) + 0.75 (3, 0, 4) = (2.1, 0, 12.8) and
//            (3, 0, 14) - (2.1, 0, 2.8) = (0.9, 0, 11.2)
TEST(LinObjective, PreviousFrameByHand) {
  const double smoothness = std::abs(2 - 1) + std::abs(std::sqrt(5.0) - 2);
  const double flock = std::hypot(2.1, 0.8) + std::hypot(3.1, 4.8);
  EXPECT_NEAR(LinObjective(ByHand(), 30, TwoAnimals(), {12, 16}), 2 * smoothness + 0.5 * flock,
              1e-6);
}

// With neighbours of the frame being solved the offset is (4, 0, 4), too far to separate.
TEST(LinObjective, CurrentFrameByHand) {
  CobylaOptions options = ByHand();
  options.current_frame = true;
  const double smoothness = std::abs(2 - 1) + std::abs(std::sqrt(5.0) - 2);
  // Targets (3, 0, 13) and (0, 0, 11).
  const double flock = std::hypot(3, 1) + std::hypot(4, 5);
  EXPECT_NEAR(LinObjective(options, 30, TwoAnimals(), {12, 16}), 2 * smoothness + 0.5 * flock,
              1e-6);
}

// Exponent 1 weighs by 1/r: offsets of length 1/5.
TEST(LinObjective, SeparationExponentByHand) {
  CobylaOptions options = ByHand();
  options.separation_exponent = 1;
  options.lambda_t = 0;
  options.lambda_sep = 1;
  options.lambda_f = 1;
  EXPECT_NEAR(LinObjective(options, 30, TwoAnimals(), {12, 16}),
              std::hypot(0.12, 2 + 0.16) + std::hypot(4 - 3.12, 16 - 14.16), 1e-6);
}

// In its second frame an animal is asked for the speed alone: 30 m/s at 30 frames/s is 1 m.
TEST(LinObjective, SecondFrameAsksForTheSpeed) {
  std::vector<LinAnimal> animals = TwoAnimals();
  for (LinAnimal& a : animals) a.solved_frames = 1;
  EXPECT_NEAR(LinObjective(ByHand(), 30, animals, {12, 16}),
              std::abs(2.0 - 1) + std::abs(std::sqrt(5.0) - 1), 1e-12);
}

// Animals that stand on their rays: (x, y) by id, seen in frames [first, last].
Segment Standing(Id id, Vec2d ray, int first, int last, double step = 0) {
  Segment segment{id, {}};
  for (int f = first; f <= last; ++f) {
    Sighting s;
    s.frame = f;
    s.time = (f - 1) / 30.0;
    s.ray = {ray.x + step * (f - first), ray.y};
    segment.sightings.push_back(s);
  }
  return segment;
}

TEST(Cobyla, FirstFrameIsMidRangeOrAssigned) {
  Segments segments;
  segments.segments = {Standing(1, {0, 0}, 1, 1), Standing(2, {0.1, 0}, 1, 1)};
  const CobylaResult result = SolveCobyla(ByHand(), {{2, 33}}, segments, 30, {});
  EXPECT_DOUBLE_EQ(result.paths[0][0].position_in_cam.z, 50.5);
  EXPECT_DOUBLE_EQ(result.paths[1][0].position_in_cam.z, 33);
  EXPECT_DOUBLE_EQ(result.paths[1][0].position_in_cam.x, 3.3);
}

// The minimum of the second frame is known: a displacement of 1 m, sideways motion included.
TEST(Cobyla, SecondFrameHasTheSpeed) {
  Segments segments;
  segments.segments = {Standing(1, {0, 0}, 1, 2, 0.01), Standing(2, {0.1, 0}, 1, 2, 0.005)};
  CobylaOptions options = ByHand();
  options.tolerance = 1e-7;
  const CobylaResult result = SolveCobyla(options, {}, segments, 30, {});
  EXPECT_LT(result.report.final_cost, 1e-3);
  for (const SolvedPath& path : result.paths) {
    EXPECT_NEAR(Norm(path[1].position_in_cam - path[0].position_in_cam), 1, 1e-3);
    EXPECT_NEAR(Norm(path[1].velocity_in_cam), 30, 0.05);
  }
}

// Animals that enter start at the flock's mean depth, after a gap at their own last one; every
// sighting has a depth inside the bounds.
TEST(Cobyla, AnimalsEnterAndLeave) {
  Segments segments;
  Segment gap = Standing(3, {-0.1, 0}, 1, 4);
  const Segment later = Standing(3, {-0.1, 0}, 8, 12);
  gap.sightings.insert(gap.sightings.end(), later.sightings.begin(), later.sightings.end());
  segments.segments = {Standing(1, {0, 0}, 1, 9, 0.004), Standing(2, {0.1, 0}, 5, 12, 0.004), gap};
  const CobylaOptions options = ByHand();
  const CobylaResult result = SolveCobyla(options, {}, segments, 30, {});
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(result.paths[i].size(), segments.segments[i].sightings.size());
    for (const SolvedPoint& p : result.paths[i]) {
      EXPECT_GE(p.position_in_cam.z, options.near);
      EXPECT_LE(p.position_in_cam.z, options.far);
    }
  }
  const double mean =
      0.5 * (result.paths[0][3].position_in_cam.z + result.paths[2][3].position_in_cam.z);
  EXPECT_DOUBLE_EQ(result.paths[1][0].position_in_cam.z, mean);
  EXPECT_DOUBLE_EQ(result.paths[2][4].position_in_cam.z, result.paths[2][3].position_in_cam.z);
}

TEST(Cobyla, BoundsMustMakeSense) {
  Segments segments;
  segments.segments = {Standing(1, {0, 0}, 1, 2)};
  CobylaOptions options = ByHand();
  options.near = 200;
  EXPECT_THROW(SolveCobyla(options, {}, segments, 30, {}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
