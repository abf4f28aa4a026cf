// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A swarm whose animals keep no speed, as insects do.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "reconstruct/reconstruct.h"
#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

constexpr double kSd = 1;         // of every component of the velocity [m/s]
constexpr double kMemory = 0.15;  // of the velocity [s]
const FlockSpec kSpec{.count = 12,
                      .frames = 180,
                      .speed = kSd * std::sqrt(8 / std::numbers::pi),
                      .center = {0, 0, 15},
                      .seed = 4};

// Every animal wanders from a home of its own.
Trajectories Swarm() {
  Trajectories truth;
  truth.fps = kSpec.fps;
  const double dt = 1 / kSpec.fps, rho = std::exp(-dt / kMemory);
  const auto normals = [](double sd, Rng* rng) {
    const double x = sd * rng->Normal(), y = sd * rng->Normal(), z = sd * rng->Normal();
    return Vec3d{x, y, z};
  };
  for (Id id = 1; id <= kSpec.count; ++id) {
    Rng rng(kSpec.seed, static_cast<std::uint64_t>(id));
    Vec3d place = kSpec.center + normals(5, &rng), velocity = normals(kSd, &rng);
    Trajectory path{id, {}};
    for (int f = 1; f <= kSpec.frames; ++f) {
      TrajectoryPoint point;
      point.frame = f;
      point.position = place;
      path.points.push_back(point);
      place += dt * velocity;
      velocity = rho * velocity + std::sqrt(1 - rho * rho) * normals(kSd, &rng);
    }
    truth.trajectories.push_back(path);
  }
  ComputeVelocities(kSpec.fps, &truth);
  return truth;
}

struct Score {
  double median = 0, constant = 0;  // of |error| in the log depth; of one depth for all
  double within = 0;                // one sd
};

Score Solved(bool sizes, bool erratic, std::string* outlook = nullptr) {
  const Camera camera = WatchingCamera();
  const Trajectories truth = Swarm();
  ReconstructOptions options;
  options.knowledge.speed = Uncertain{kSpec.speed, 0.1 * kSpec.speed};
  options.knowledge.wingspan = Uncertain{kSpec.wingspan, 0.05 * kSpec.wingspan};
  options.knowledge.use_size = sizes;
  options.batch.erratic_flight = erratic;
  options.method = ReconstructMethod::kDynamics;
  const auto result =
      Reconstruct(options, Observe(kSpec, {}, truth, camera), camera, kSpec.fps, 1, {});
  if (outlook != nullptr) *outlook = result.report.outlook + result.report.observability;
  std::vector<double> logs, errors;
  double within = 0;
  for (const Trajectory& path : result.trajectories.trajectories) {
    const auto& of_truth = truth.trajectories[static_cast<std::size_t>(path.id - 1)].points;
    for (const TrajectoryPoint& p : path.points) {
      const auto depth = [&](const Vec3d& x) { return (camera.CamFromWorld(p.frame) * x).z; };
      const double z = depth(of_truth[static_cast<std::size_t>(p.frame - 1)].position);
      logs.push_back(std::log(z));
      errors.push_back(std::abs(std::log(depth(p.position) / z)));
      within += std::abs(depth(p.position) - z) < p.sd_depth;
    }
  }
  const auto median = [](std::vector<double> v) {
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
  };
  Score score{.median = median(errors)};
  score.within = within / static_cast<double>(errors.size());
  const double middle = median(logs);
  for (double& log_depth : logs) log_depth = std::abs(log_depth - middle);
  score.constant = median(logs);
  return score;
}

TEST(ErraticFlight, SizesTellDepths) {
  std::string outlook;
  const Score score = Solved(true, true, &outlook);
  EXPECT_LT(score.median, 0.6 * score.constant);
  EXPECT_GT(score.within, 0.5);
  EXPECT_THAT(outlook, testing::HasSubstr("erratic flight"));
  EXPECT_THAT(outlook, testing::HasSubstr("animals keep no speed"));
  EXPECT_THAT(outlook, testing::HasSubstr("forces left out"));
}

// Before anything is solved, and only where it will be solved so.
TEST(ErraticFlight, IsToldBeforehand) {
  const Camera camera = WatchingCamera();
  const Tracks tracks = Observe(kSpec, {}, Swarm(), camera);
  ReconstructOptions options;
  options.knowledge.speed = Uncertain{kSpec.speed, 0.1 * kSpec.speed};
  const auto outlook = [&] { return LookAhead(options, tracks, camera, kSpec.fps); };
  EXPECT_THAT(outlook(), testing::HasSubstr("erratic flight"));
  options.method = ReconstructMethod::kCobyla;
  EXPECT_THAT(outlook(), testing::Not(testing::HasSubstr("erratic")));
  options.method = ReconstructMethod::kBatch;
  options.batch.erratic_flight = false;
  EXPECT_THAT(outlook(), testing::Not(testing::HasSubstr("erratic")));
}

// Nothing tells depths then, and it is known. Animals taken to keep their speed fly along the line
// of sight wherever they slow down across it.
TEST(ErraticFlight, WithoutSizesNothingIsMadeUp) {
  const Score score = Solved(false, true), steady = Solved(false, false);
  EXPECT_LT(score.median, 1.5 * score.constant);
  EXPECT_GT(score.within, 0.5);
  EXPECT_GT(steady.median, 1.5 * score.median);
  EXPECT_LT(steady.within, score.within);
}

}  // namespace
}  // namespace flocklift
