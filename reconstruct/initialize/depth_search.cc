// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/depth_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr int kMaxSlope = 6;  // grid steps of log depth per step of time, either way
constexpr int kSlopes = 2 * kMaxSlope + 1;
constexpr int kMaxLevels = 400;
constexpr double kNever = std::numeric_limits<double>::infinity();

constexpr double kLimit = 3;

// Half the square, linear from the limit on.
double Robust(double r) {
  const double a = std::abs(r);
  return a <= kLimit ? 0.5 * a * a : kLimit * (a - 0.5 * kLimit);
}
// The same of the root of a square.
double RobustOfRoot(double square) {
  return square <= kLimit * kLimit ? 0.5 * square : kLimit * (std::sqrt(square) - 0.5 * kLimit);
}

// The levels of log depth, and what paths over them cost.
class Grid {
 public:
  Grid(const DepthSearchPriors& priors, double interval, const std::vector<DepthSearchStep>& steps)
      : priors_(priors), interval_(interval), steps_(steps) {
    FLOCKLIFT_DCHECK(!steps.empty() && priors.log_far > priors.log_near);
    // A slope of kMaxSlope is flight straight along the ray at 1.5 times the mean speed, seen from
    // the flock's middle, against the camera's own motion.
    double fastest = 1.5 * std::exp(priors.log_speed) * interval;
    for (std::size_t k = 1; k < steps.size(); ++k) {
      fastest = std::max(fastest, 1.5 * std::exp(priors.log_speed) * interval +
                                      Norm(steps[k].camera - steps[k - 1].camera));
    }
    const double steepest = fastest * std::exp(-priors.log_depth);
    const double range = priors.log_far - priors.log_near;
    cell_ = std::max(steepest / kMaxSlope, range / (kMaxLevels - 1));
    levels_ = std::max(2, static_cast<int>(std::ceil(range / cell_)) + 1);
    for (int i = 0; i < levels_; ++i) depth_.push_back(std::exp(LogDepth(i)));
    const auto share = [interval](double time) { return std::min(1.0, interval / (2 * time)); };
    speed_share_ = share(priors.speed_time);
    size_share_ = share(priors.size_time);
    depth_share_ = share(priors.depth_time);
    climb_share_ = share(priors.climb_time);
    // The grid itself makes accelerations of a third of a cell.
    const double grid_sd = 0.33 * cell_ * std::exp(priors.log_depth) / (interval * interval);
    acceleration_sd_ =
        std::hypot(priors.acceleration_sd / std::sqrt(share(priors.acceleration_time)), grid_sd);
  }

  int levels() const { return levels_; }
  double LogDepth(int level) const {
    return std::min(priors_.log_near + level * cell_, priors_.log_far);
  }
  // Slopes that lead from a level to another one: from Low to High.
  int Low(int level) const { return std::max(-kMaxSlope, -level); }
  int High(int level) const { return std::min(kMaxSlope, levels_ - 1 - level); }

  // One step of time: where every level is, and what it costs to be there.
  struct Layer {
    std::vector<Vec3d> point;
    std::vector<double> cost;
  };
  Layer LayerOf(int k) const {
    Layer layer;
    const DepthSearchStep& step = steps_[k];
    for (int i = 0; i < levels_; ++i) {
      const double l = LogDepth(i);
      double cost = depth_share_ * Robust((l - priors_.log_depth) / priors_.depth_sd);
      if (step.log_size) {
        cost += size_share_ * Robust((*step.log_size - priors_.log_width + l) / priors_.size_sd);
      }
      if (step.log_depth) cost += Robust((*step.log_depth - l) / std::max(cell_, 0.02));
      layer.cost.push_back(cost);
      layer.point.push_back(step.camera + depth_[i] * Vec3d{step.ray.x, step.ray.y, 1});
    }
    return layer;
  }

  // Of getting from one step to the next.
  double OfMotion(const Vec3d& d) const {
    const double square = SquaredNorm(d) + 1e-12;
    const double log_speed = 0.5 * std::log(square) - log_interval_;
    double cost = speed_share_ * Robust((log_speed - priors_.log_speed) / priors_.speed_sd);
    if (priors_.up_in_cam) {
      cost +=
          climb_share_ * Robust(Dot(d, *priors_.up_in_cam) / std::sqrt(square) / priors_.climb_sd);
    }
    return cost;
  }
  // What one over an acceleration's sd is, there, for the change from one step's way to the next's.
  double BendFactor(int level) const {
    return std::exp(priors_.log_depth) / (interval_ * interval_ * acceleration_sd_ * depth_[level]);
  }

 private:
  const DepthSearchPriors& priors_;
  double interval_, log_interval_ = std::log(interval_);
  const std::vector<DepthSearchStep>& steps_;
  double cell_ = 0, acceleration_sd_ = 0;
  int levels_ = 0;
  double speed_share_ = 0, size_share_ = 0, depth_share_ = 0, climb_share_ = 0;
  std::vector<double> depth_;  // of every level
};

// All ways into one level, by slope.
struct WaysIn {
  static constexpr int kLanes = kSlopes + 1;  // even, for vector instructions
  std::array<double, kLanes> cost, x{}, y{}, z{}, square;

  // Which one goes on best by `out`, and at what cost; `bend_weight` is of the squared change of
  // the way, `straight_on` the one of the same slope.
  std::pair<int, double> Best(int straight_on, const Vec3d& out, double bend_weight) {
    for (int r = 0; r < kLanes; ++r) {
      const double dx = out.x - x[r], dy = out.y - y[r], dz = out.z - z[r];
      square[r] = bend_weight * (dx * dx + dy * dy + dz * dz);
    }
    // Straight on is usually best, and spares looking at most others.
    int chosen = straight_on;
    double least = cost[chosen] + RobustOfRoot(square[chosen]);
    for (int r = 0; r < kSlopes; ++r) {
      if (cost[r] >= least) continue;
      const double whole = cost[r] + RobustOfRoot(square[r]);
      if (whole < least) {
        least = whole;
        chosen = r;
      }
    }
    return {chosen, least};
  }
};

}  // namespace

std::vector<double> SearchDepth(const DepthSearchPriors& priors, double interval,
                                const std::vector<DepthSearchStep>& steps) {
  const Grid grid(priors, interval, steps);
  const int count = static_cast<int>(steps.size()), levels = grid.levels();
  std::vector<double> result(steps.size());
  Grid::Layer before, here = grid.LayerOf(0);
  if (count == 1) {
    const auto best = std::min_element(here.cost.begin(), here.cost.end());
    result[0] = grid.LogDepth(static_cast<int>(best - here.cost.begin()));
    return result;
  }

  // best[level, slope]: least cost of all up to step k + 1, with level the one at step k.
  const std::size_t states = static_cast<std::size_t>(levels) * kSlopes;
  std::vector<double> best(states, kNever), next(states);
  std::vector<std::uint8_t> came_from(states * static_cast<std::size_t>(count - 1));
  const auto at = [](int level, int slope) {
    return static_cast<std::size_t>(level) * kSlopes + static_cast<std::size_t>(slope + kMaxSlope);
  };
  Grid::Layer after = grid.LayerOf(1);
  for (int i = 0; i < levels; ++i) {
    for (int s = grid.Low(i); s <= grid.High(i); ++s) {
      best[at(i, s)] =
          here.cost[i] + after.cost[i + s] + grid.OfMotion(after.point[i + s] - here.point[i]);
    }
  }
  WaysIn ways;
  for (int k = 1; k + 1 < count; ++k) {
    before = std::move(here);
    here = std::move(after);
    after = grid.LayerOf(k + 1);
    std::fill(next.begin(), next.end(), kNever);
    std::uint8_t* from = &came_from[static_cast<std::size_t>(k) * states];
    for (int i = 0; i < levels; ++i) {  // level at step k
      ways.cost.fill(kNever);
      for (int s = -grid.High(i); s <= -grid.Low(i); ++s) {
        const Vec3d in = here.point[i] - before.point[i - s];
        const int r = s + kMaxSlope;
        ways.cost[r] = best[at(i - s, s)];
        ways.x[r] = in.x;
        ways.y[r] = in.y;
        ways.z[r] = in.z;
      }
      const double factor = grid.BendFactor(i);
      for (int s = grid.Low(i); s <= grid.High(i); ++s) {
        const Vec3d out = after.point[i + s] - here.point[i];
        const auto [chosen, least] = ways.Best(s + kMaxSlope, out, factor * factor);
        if (least == kNever) continue;
        next[at(i, s)] = least + after.cost[i + s] + grid.OfMotion(out);
        from[at(i, s)] = static_cast<std::uint8_t>(chosen);
      }
    }
    best.swap(next);
  }
  const std::size_t last =
      static_cast<std::size_t>(std::min_element(best.begin(), best.end()) - best.begin());
  int level = static_cast<int>(last / kSlopes);
  int slope = static_cast<int>(last % kSlopes) - kMaxSlope;
  result[count - 1] = grid.LogDepth(level + slope);
  for (int k = count - 2; k >= 0; --k) {
    result[k] = grid.LogDepth(level);
    if (k == 0) break;
    const int before = came_from[static_cast<std::size_t>(k) * states + at(level, slope)];
    slope = before - kMaxSlope;
    level -= slope;
  }
  return result;
}

}  // namespace flocklift
