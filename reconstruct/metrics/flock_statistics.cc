// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/metrics/flock_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "reconstruct/metrics/order_statistics.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace {

double Along(const Vec3d& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

int LongestAxis(std::span<const Vec3d> positions) {
  int longest = 0;
  double length = -1;
  for (int axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3d& p : positions) {
      low = std::min(low, Along(p, axis));
      high = std::max(high, Along(p, axis));
    }
    if (high - low > length) {
      length = high - low;
      longest = axis;
    }
  }
  return longest;
}

}  // namespace

std::optional<double> Polarisation(std::span<const Vec3d> velocities) {
  Vec3d sum;
  int moving = 0;
  for (const Vec3d& velocity : velocities) {
    const Vec3d direction = Normalized(velocity);
    if (direction == Vec3d{}) continue;
    sum += direction;
    ++moving;
  }
  if (moving == 0) return std::nullopt;
  return Norm(sum) / moving;
}

std::vector<double> NearestNeighbourDistances(std::span<const Vec3d> positions) {
  const std::size_t n = positions.size();
  if (n < 2) return {};
  const int axis = LongestAxis(positions);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return Along(positions[a], axis) < Along(positions[b], axis);
  });
  std::vector<double> squared(n, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3d& here = positions[order[k]];
    double& nearest = squared[order[k]];
    for (std::size_t m = k + 1; m < n; ++m) {
      const double ahead = Along(positions[order[m]], axis) - Along(here, axis);
      if (ahead * ahead >= nearest) break;
      nearest = std::min(nearest, SquaredNorm(positions[order[m]] - here));
    }
    for (std::size_t m = k; m-- > 0;) {
      const double behind = Along(here, axis) - Along(positions[order[m]], axis);
      if (behind * behind >= nearest) break;
      nearest = std::min(nearest, SquaredNorm(positions[order[m]] - here));
    }
  }
  for (double& distance : squared) distance = std::sqrt(distance);
  return squared;
}

StatesByFrame::StatesByFrame(const Trajectories& trajectories) {
  Check(trajectories.has_velocity,
        "flock statistics need velocities: call ComputeVelocities first");
  for (const Trajectory& trajectory : trajectories.trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) frames_.push_back(point.frame);
  }
  std::sort(frames_.begin(), frames_.end());
  frames_.erase(std::unique(frames_.begin(), frames_.end()), frames_.end());
  states_.resize(frames_.size());
  for (const Trajectory& trajectory : trajectories.trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) {
      const auto k =
          std::lower_bound(frames_.begin(), frames_.end(), point.frame) - frames_.begin();
      states_[k].id.push_back(trajectory.id);
      states_[k].position.push_back(point.position);
      states_[k].velocity.push_back(point.velocity);
    }
  }
}

std::vector<FlockStatistics> ComputeFlockStatistics(const StatesByFrame& states, int stride) {
  Check(stride >= 1, "the stride of flock statistics is at least 1");
  std::vector<FlockStatistics> all;
  for (std::size_t k = 0; k < states.frames().size(); k += static_cast<std::size_t>(stride)) {
    const FlockState& state = states.state(k);
    FlockStatistics s;
    s.frame = states.frames()[k];
    s.count = static_cast<int>(state.size());
    s.polarisation = Polarisation(state.velocity);
    std::vector<double> speeds;
    for (const Vec3d& velocity : state.velocity) speeds.push_back(Norm(velocity));
    std::sort(speeds.begin(), speeds.end());
    s.speed_low = QuantileOfSorted(speeds, 0.1);
    s.speed_median = QuantileOfSorted(speeds, 0.5);
    s.speed_high = QuantileOfSorted(speeds, 0.9);
    std::vector<double> distances = NearestNeighbourDistances(state.position);
    if (!distances.empty()) {
      std::sort(distances.begin(), distances.end());
      s.neighbour_low = QuantileOfSorted(distances, 0.1);
      s.neighbour_median = QuantileOfSorted(distances, 0.5);
      s.neighbour_high = QuantileOfSorted(distances, 0.9);
    }
    all.push_back(s);
  }
  return all;
}

StepStatistics ComputeSteps(const Trajectories& trajectories, double fps) {
  Check(fps > 0, "fps must be positive to compute the speed of a step");
  std::vector<double> speeds;
  for (const Trajectory& trajectory : trajectories.trajectories) {
    for (std::size_t k = 1; k < trajectory.points.size(); ++k) {
      const TrajectoryPoint &from = trajectory.points[k - 1], &to = trajectory.points[k];
      speeds.push_back(Norm(to.position - from.position) * fps / (to.frame - from.frame));
    }
  }
  StepStatistics steps;
  if (speeds.empty()) return steps;
  std::sort(speeds.begin(), speeds.end());
  steps.steps = speeds.size();
  steps.median = QuantileOfSorted(speeds, 0.5);
  steps.p99 = QuantileOfSorted(speeds, 0.99);
  steps.largest = speeds.back();
  steps.jumps = static_cast<std::size_t>(
      speeds.end() -
      std::upper_bound(speeds.begin(), speeds.end(), StepStatistics::kJump * steps.median));
  return steps;
}

}  // namespace flocklift
