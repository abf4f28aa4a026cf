// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/opensteer_motion.h"

#include <gtest/gtest.h>

#include "tests/simulate/flock/flocks.h"
#include "tests/simulate/flock/motion_checks.h"

namespace flocklift {
namespace {

// The rules and nothing else.
OpenSteerParameters Plain(double max_force = 27) {
  OpenSteerParameters p;
  p.max_force = max_force;
  p.alpha_b = 0;
  return p;
}

Vec3d Unit(const Vec3d& v) { return Norm(v) > 1e-9 ? v / Norm(v) : Vec3d{}; }

// Written from OpenSteer's description, rule by rule.
Vec3d Steering(const NamedFlock& flock, std::size_t k, double max_force) {
  const Vec3d forward = Unit(flock.velocity[k]);
  const auto sees = [&](const Vec3d& offset, double radius, double cosine) {
    const double distance = Norm(offset);
    if (distance >= radius) return false;
    return distance < 1.5 || Dot(forward, offset) / distance >= cosine;
  };
  Vec3d away, heading, centre;
  int aligned = 0, together = 0;
  for (std::size_t j = 0; j < flock.position.size(); ++j) {
    if (j == k) continue;
    const Vec3d offset = flock.position[j] - flock.position[k];
    if (sees(offset, 5, -0.707)) away += offset / -Dot(offset, offset);
    if (sees(offset, 7.5, 0.7)) {
      heading += Unit(flock.velocity[j]);
      ++aligned;
    }
    if (sees(offset, 9, -0.15)) {
      centre += flock.position[j];
      ++together;
    }
  }
  Vec3d sum = 12 * Unit(away);
  if (aligned > 0) sum += 8 * Unit(heading / aligned - forward);
  if (together > 0) sum += 8 * Unit(centre / together - flock.position[k]);
  return Norm(sum) > max_force ? max_force * Unit(sum) : sum;
}

TEST(OpenSteerMotion, SteersAsDescribed) {
  const NamedFlock flock = RandomFlock("", 150, {20, 20, 20}, 41);
  for (const double max_force : {27.0, 6.0}) {
    World world;
    ReferenceEngine engine(world, {AsSwarm(flock, Plain(max_force))}, {});
    engine.Step();
    const auto accelerations = engine.Accelerations();
    for (std::size_t k = 0; k < 150; ++k) {
      EXPECT_LT(Norm(accelerations[k] - Steering(flock, k, max_force)), 1e-6) << k;
    }
  }
}

TEST(OpenSteerMotion, SameBytesAtAnyThreadCountAndWithAnyKernel) {
  ExpectSameBytesEverywhere(OpenSteerParameters{});
}

// From all directions, in flocks that part but agree within.
TEST(OpenSteerMotion, FlocksForm) {
  const auto agreement = [](const FlockState& state) {  // of those nearer than 5 m
    double sum = 0, pairs = 0;
    for (std::size_t k = 0; k < state.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        if (Norm(state.position[k] - state.position[j]) > 5) continue;
        sum += Dot(Normalized(state.velocity[k]), Normalized(state.velocity[j]));
        ++pairs;
      }
    }
    return pairs > 0 ? sum / pairs : 0;
  };
  World world;
  world.dt = 1.0 / 30;
  Engine engine(world, {AsSwarm(RandomFlock("", 200, {12, 12, 12}, 43), Plain())}, {});
  EXPECT_LT(agreement(engine.State()), 0.2);
  for (int step = 0; step < 150; ++step) engine.Step();
  const FlockState after = engine.State();
  EXPECT_GT(agreement(after), 0.8);
  for (const Vec3d& v : after.velocity) EXPECT_LE(Norm(v), 9 + 1e-3);
}

}  // namespace
}  // namespace flocklift
