// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/occupants.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flocklift {
namespace {

constexpr double kMostMassCost = 4;
constexpr double kCenterVariance = 0.1;  // of a blob's centre, to its own second moments
constexpr double kMostCenterCost = 10;
constexpr double kMomentWeight = 4;  // independent values that a blob's second moments are worth
constexpr double kMostMomentCost = 10;
constexpr double kAbsentCost = 3;  // an animal predicted inside is not

double SpreadOf(const Moments& m) { return 0.5 * (m.xx + m.yy); }

// Kullback-Leibler divergence of a Gaussian with second moments a from one with b.
double Divergence(const Moments& a, const Moments& b) {
  const double det_a = a.xx * a.yy - a.xy * a.xy, det_b = b.xx * b.yy - b.xy * b.xy;
  const double trace = (b.yy * a.xx - 2 * b.xy * a.xy + b.xx * a.yy) / det_b;
  return 0.5 * (trace - 2 - std::log(det_a / det_b));
}

// Of all together: less than the sum, as they hide each other.
double MassTogether(std::span<const Expectation> animals) {
  double together = 0;
  for (std::size_t a = 0; a < animals.size(); ++a) {
    const Expectation& x = animals[a];
    together += x.mass;
    for (std::size_t b = 0; b < a; ++b) {
      const Expectation& y = animals[b];
      const double dx = x.position.x - y.position.x, dy = x.position.y - y.position.y;
      together -=
          std::min(x.mass, y.mass) *
          std::exp(-(dx * dx + dy * dy) / (2 * (SpreadOf(x.moments) + SpreadOf(y.moments))));
    }
  }
  return std::max(together, animals[0].mass);
}

}  // namespace

double MassCost(double mass, double expected) {
  const double z = std::log(mass / expected) / kLogMassSd;
  return std::min(0.5 * z * z, kMostMassCost);
}

double OccupantsCost(const Blob& blob, std::span<const Expectation> animals) {
  double total = 0, variance = 0;
  Vec2d center{};
  for (const Expectation& x : animals) {
    total += x.mass;
    center.x += x.mass * x.position.x;
    center.y += x.mass * x.position.y;
    variance += x.mass * x.mass * x.variance;
  }
  center = {center.x / total, center.y / total};
  Moments mixed;
  for (const Expectation& x : animals) {
    const double w = x.mass / total;
    const double dx = x.position.x - center.x, dy = x.position.y - center.y;
    mixed.xx += w * (x.moments.xx + dx * dx);
    mixed.xy += w * (x.moments.xy + dx * dy);
    mixed.yy += w * (x.moments.yy + dy * dy);
  }
  const double spread = variance / (total * total) + kCenterVariance * SpreadOf(mixed);
  const double ox = blob.center.x - center.x, oy = blob.center.y - center.y;
  return MassCost(blob.mass, MassTogether(animals)) +
         std::min(0.5 * (ox * ox + oy * oy) / spread + std::log(spread), kMostCenterCost) +
         std::min(kMomentWeight * Divergence(blob.moments, mixed), kMostMomentCost);
}

std::vector<std::size_t> FindOccupants(const Blob& blob, std::span<const Expectation> animals) {
  std::vector<std::size_t> inside(animals.size());
  std::iota(inside.begin(), inside.end(), std::size_t{0});
  std::vector<Expectation> present(animals.begin(), animals.end());
  double cost = OccupantsCost(blob, present);
  while (inside.size() >= 2) {
    double least = cost;
    std::size_t absent = inside.size();
    for (std::size_t out = 0; out < inside.size(); ++out) {
      std::vector<Expectation> fewer = present;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(out));
      const double fewer_cost = OccupantsCost(blob, fewer) + kAbsentCost;
      if (fewer_cost < least) {
        least = fewer_cost;
        absent = out;
      }
    }
    if (absent == inside.size()) break;
    inside.erase(inside.begin() + static_cast<std::ptrdiff_t>(absent));
    present.erase(present.begin() + static_cast<std::ptrdiff_t>(absent));
    cost = least - kAbsentCost;
  }
  return inside;
}

}  // namespace flocklift
