// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/depth_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr int kMaxSlope = 6;  // grid steps of log depth per step of time, either way
constexpr int kSlopes = 2 * kMaxSlope + 1;
constexpr int kMaxLevels = 400;

// Half the square, linear from 3 on.
double Robust(double r) {
  constexpr double kLimit = 3;
  const double a = std::abs(r);
  return a <= kLimit ? 0.5 * a * a : kLimit * (a - 0.5 * kLimit);
}

}  // namespace

std::vector<double> SearchDepth(const DepthSearchPriors& p, double interval,
                                const std::vector<DepthSearchStep>& steps) {
  FLOCKLIFT_DCHECK(!steps.empty() && p.log_far > p.log_near);
  const int count = static_cast<int>(steps.size());
  // A slope of kMaxSlope is flight straight along the ray at 1.5 times the mean speed, seen from
  // the flock's middle, against the camera's own motion.
  double fastest = 1.5 * std::exp(p.log_speed) * interval;
  for (int k = 1; k < count; ++k) {
    fastest = std::max(fastest, 1.5 * std::exp(p.log_speed) * interval +
                                    Norm(steps[k].camera - steps[k - 1].camera));
  }
  const double steepest = fastest * std::exp(-p.log_depth);
  const double range = p.log_far - p.log_near;
  const double cell = std::max(steepest / kMaxSlope, range / (kMaxLevels - 1));
  const int levels = std::max(2, static_cast<int>(std::ceil(range / cell)) + 1);
  const auto log_depth = [&](int level) { return std::min(p.log_near + level * cell, p.log_far); };
  const double reference_depth = std::exp(p.log_depth);

  std::vector<double> depth(static_cast<std::size_t>(levels));
  for (int i = 0; i < levels; ++i) depth[i] = std::exp(log_depth(i));
  const auto share = [interval](double time) { return std::min(1.0, interval / (2 * time)); };
  const double speed_share = share(p.speed_time), size_share = share(p.size_time);
  const double depth_share = share(p.depth_time), climb_share = share(p.climb_time);
  // The grid itself makes accelerations of a third of a cell.
  const double grid_sd = 0.33 * cell * reference_depth / (interval * interval);
  const double acceleration_sd =
      std::hypot(p.acceleration_sd / std::sqrt(share(p.acceleration_time)), grid_sd);

  const auto point = [&](int k, int level) {
    return steps[k].camera + depth[level] * Vec3d{steps[k].ray.x, steps[k].ray.y, 1};
  };
  const auto unary = [&](int k, int level) {
    const double l = log_depth(level);
    double cost = depth_share * Robust((l - p.log_depth) / p.depth_sd);
    if (steps[k].log_size) {
      cost += size_share * Robust((*steps[k].log_size - p.log_width + l) / p.size_sd);
    }
    if (steps[k].log_depth) cost += Robust((*steps[k].log_depth - l) / std::max(cell, 0.02));
    return cost;
  };
  const auto motion = [&](int k, int level, int slope) {
    const Vec3d d = point(k + 1, level + slope) - point(k, level);
    const double length = std::sqrt(SquaredNorm(d) + 1e-12);
    double cost = speed_share * Robust((std::log(length / interval) - p.log_speed) / p.speed_sd);
    if (p.up_in_cam) cost += climb_share * Robust(Dot(d, *p.up_in_cam) / length / p.climb_sd);
    return cost;
  };

  std::vector<double> result(steps.size());
  if (count == 1) {
    int best = 0;
    for (int i = 1; i < levels; ++i) {
      if (unary(0, i) < unary(0, best)) best = i;
    }
    result[0] = log_depth(best);
    return result;
  }

  // best[level, slope]: least cost of all up to step k + 1, with level the one at step k.
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const std::size_t states = static_cast<std::size_t>(levels) * kSlopes;
  std::vector<double> best(states, kNever), next(states);
  std::vector<std::int8_t> came_from(states * static_cast<std::size_t>(count - 1));
  const auto at = [](int level, int slope) {
    return static_cast<std::size_t>(level) * kSlopes + static_cast<std::size_t>(slope + kMaxSlope);
  };
  const auto low = [](int level) { return std::max(-kMaxSlope, -level); };
  const auto high = [levels](int level) { return std::min(kMaxSlope, levels - 1 - level); };
  for (int i = 0; i < levels; ++i) {
    for (int s = low(i); s <= high(i); ++s) {
      best[at(i, s)] = unary(0, i) + unary(1, i + s) + motion(0, i, s);
    }
  }
  const double inverse = 1 / (interval * interval * acceleration_sd);
  for (int k = 1; k + 1 < count; ++k) {
    std::fill(next.begin(), next.end(), kNever);
    std::int8_t* from = &came_from[static_cast<std::size_t>(k) * states];
    for (int i = 0; i < levels; ++i) {  // level at step k
      const Vec3d here = point(k, i);
      const double factor = inverse * reference_depth / depth[i];
      std::array<double, kSlopes> before_cost;
      std::array<Vec3d, kSlopes> step_in;
      for (int s = -kMaxSlope; s <= kMaxSlope; ++s) {
        const int before = i - s;
        const bool inside = before >= 0 && before < levels;
        before_cost[s + kMaxSlope] = inside ? best[at(before, s)] : kNever;
        if (inside) step_in[s + kMaxSlope] = here - point(k - 1, before);
      }
      for (int s = low(i); s <= high(i); ++s) {
        const Vec3d step_out = point(k + 1, i + s) - here;
        double least = kNever;
        int chosen = 0;
        for (int r = 0; r < kSlopes; ++r) {
          if (before_cost[r] >= least) continue;
          const Vec3d bend = step_out - step_in[r];
          const double cost = before_cost[r] + Robust(factor * std::sqrt(SquaredNorm(bend)));
          if (cost < least) {
            least = cost;
            chosen = r;
          }
        }
        if (least == kNever) continue;
        next[at(i, s)] = least + unary(k + 1, i + s) + motion(k, i, s);
        from[at(i, s)] = static_cast<std::int8_t>(chosen);
      }
    }
    best.swap(next);
  }
  const std::size_t last =
      static_cast<std::size_t>(std::min_element(best.begin(), best.end()) - best.begin());
  int level = static_cast<int>(last / kSlopes);
  int slope = static_cast<int>(last % kSlopes) - kMaxSlope;
  result[count - 1] = log_depth(level + slope);
  for (int k = count - 2; k >= 0; --k) {
    result[k] = log_depth(level);
    if (k == 0) break;
    const int before = came_from[static_cast<std::size_t>(k) * states + at(level, slope)];
    slope = before - kMaxSlope;
    level -= slope;
  }
  return result;
}

}  // namespace flocklift
