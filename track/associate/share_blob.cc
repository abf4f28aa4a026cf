// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/share_blob.h"

#include <algorithm>
#include <cmath>

namespace flocklift {
namespace {

constexpr int kMostIterations = 12;
constexpr double kRests = 1e-4;          // squared [px^2]: no mean moved farther
constexpr double kNoShare = -16;         // ln: less counts as nothing
constexpr double kLeastVariance = 0.25;  // of an animal's own shape [px^2]

// Inverse covariance and log weight of one mixture component.
struct Gaussian {
  double xx = 0, xy = 0, yy = 0, log_weight = 0;

  explicit Gaussian(const Expectation& a) {
    const double cxx = a.moments.xx + kLeastVariance, cyy = a.moments.yy + kLeastVariance;
    const double det = cxx * cyy - a.moments.xy * a.moments.xy;
    xx = cyy / det;
    xy = -a.moments.xy / det;
    yy = cxx / det;
    log_weight = std::log(std::max(a.mass, 1e-9)) - 0.5 * std::log(det);
  }
};

}  // namespace

std::vector<BlobShare> ShareBlob(std::span<const BlobPixel> pixels,
                                 std::span<const Expectation> animals) {
  const std::size_t count = animals.size();
  std::vector<Gaussian> gaussians;
  std::vector<BlobShare> shares(count);
  std::vector<Vec2d> means(count);
  for (std::size_t k = 0; k < count; ++k) {
    gaussians.emplace_back(animals[k]);
    means[k] = animals[k].position;
  }
  std::vector<double> log_share(count), sum(count), sum_x(count), sum_y(count), sum_squared(count);
  double moved = 1;
  for (int iteration = 0; iteration < kMostIterations && moved > kRests; ++iteration) {
    moved = 0;
    for (std::size_t k = 0; k < count; ++k) sum[k] = sum_x[k] = sum_y[k] = sum_squared[k] = 0;
    for (const BlobPixel& p : pixels) {
      double best = -1e300;
      for (std::size_t k = 0; k < count; ++k) {
        const double dx = p.x - means[k].x, dy = p.y - means[k].y;
        const Gaussian& g = gaussians[k];
        log_share[k] = g.log_weight - 0.5 * (g.xx * dx * dx + 2 * g.xy * dx * dy + g.yy * dy * dy);
        best = std::max(best, log_share[k]);
      }
      double total = 0;
      for (double& share : log_share) {
        const double below = share - best;
        share = below == 0 ? 1 : below < kNoShare ? 0 : std::exp(static_cast<float>(below));
        total += share;
      }
      for (std::size_t k = 0; k < count; ++k) {
        if (log_share[k] == 0) continue;
        const double share = log_share[k] / total, weight = share * p.contrast;
        sum[k] += weight;
        sum_x[k] += weight * p.x;
        sum_y[k] += weight * p.y;
        sum_squared[k] += weight * share;
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      const Expectation& a = animals[k];
      if (sum[k] < 1e-6) {
        shares[k] = {a.position, 1e6, 1};
        continue;
      }
      const double ambiguity = 1 - sum_squared[k] / sum[k];
      const double variance =
          a.noise + ambiguity * 0.5 * (a.moments.xx + a.moments.yy + 2 * kLeastVariance);
      shares[k] = {{sum_x[k] / sum[k], sum_y[k] / sum[k]}, variance, ambiguity};
      const double w = a.variance / (a.variance + variance);
      const Vec2d mean{w * shares[k].position.x + (1 - w) * a.position.x,
                       w * shares[k].position.y + (1 - w) * a.position.y};
      const double dx = mean.x - means[k].x, dy = mean.y - means[k].y;
      moved = std::max(moved, dx * dx + dy * dy);
      means[k] = mean;
    }
  }
  return shares;
}

}  // namespace flocklift
