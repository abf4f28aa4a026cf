// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/limited_velocity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flocklift {
namespace {

constexpr double kFarAway = 6;        // sd
constexpr double kUnlimited = 0.999;  // of a deviation is let through

double Density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi); }
double Below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

struct Tail {
  double share = 0;   // P(z > t), z ~ N(0, 1)
  double mean = 0;    // E[max(0, z - t)]
  double square = 0;  // E[max(0, z - t)^2]
};

Tail Beyond(double t) {
  const double share = Below(-t), density = Density(t);
  return {share, density - t * share, (1 + t * t) * share - t * density};
}

}  // namespace

bool IsNearLimit(const SpeedRange& range, double speed, double sd) {
  const bool slow = range.low > 0 && speed - range.low < kFarAway * sd;
  return slow || range.high - speed < kFarAway * sd;
}

LimitedVelocity LimitVelocity(const SpeedRange& range, const Eigen::Vector3d& mean,
                              const Eigen::Matrix3d& covariance, double least) {
  const double m = mean.norm();
  const Eigen::Vector3d along = mean / m;
  const double square = std::max(along.dot(covariance * along), 1e-300);
  const double sigma = std::sqrt(square);
  const double speed = m + (covariance.trace() - square) / (2 * m);
  // s' = s + what is missing from low - what is beyond high, the two never together; in sigma.
  const Tail missing = range.low > 0 ? Beyond((speed - range.low) / sigma) : Tail{};
  const Tail surplus = Beyond((range.high - speed) / sigma);
  const double shift = missing.mean - surplus.mean;
  const double kept = std::max(0.0, 1 - missing.share - surplus.share);
  // E[z max(0, -z - t)] = -P(z < -t), by parts; likewise above.
  const double variance =
      1 + missing.square + surplus.square - shift * shift - 2 * missing.share - 2 * surplus.share;
  const double limited = speed + sigma * shift;
  const double noise = std::max(square * variance, std::min(least, square)) - square * kept * kept;
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), line = along * along.transpose();
  return {.mean = m / speed * limited * along,
          .kept = kept * line + limited / speed * (one - line),
          .noise = std::max(0.0, noise) * line,
          .acts = kept < kUnlimited};
}

}  // namespace flocklift
