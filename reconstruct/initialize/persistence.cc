// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/persistence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flocklift {
namespace {

constexpr double kSpan = 0.25;       // of a velocity [s]
constexpr double kTolerance = 0.25;  // of spans and lags, as a share of the span
constexpr long kFewest = 20;         // pairs that tell

struct Velocity {
  double time = 0;   // at the beginning
  Vec2d ray;         // [1/s]
  double noise = 0;  // of |ray|^2
};

std::vector<Velocity> VelocitiesOf(const std::vector<Sighting>& s) {
  std::vector<Velocity> velocities;
  for (std::size_t begin = 0, end = 0; begin < s.size(); ++begin) {
    while (end < s.size() && s[end].time - s[begin].time < kSpan * (1 - kTolerance)) ++end;
    if (end == s.size()) break;
    const double dt = s[end].time - s[begin].time;
    if (dt > kSpan * (1 + kTolerance)) continue;
    const double variance = s[begin].ray_sd * s[begin].ray_sd + s[end].ray_sd * s[end].ray_sd;
    velocities.push_back(
        {s[begin].time,
         {(s[end].ray.x - s[begin].ray.x) / dt, (s[end].ray.y - s[begin].ray.y) / dt},
         2 * variance / (dt * dt)});
  }
  return velocities;
}

}  // namespace

double PersistenceOf(const std::vector<Segment>& segments) {
  double products = 0, squares = 0;
  long pairs = 0;
  for (const Segment& segment : segments) {
    const std::vector<Velocity> all = VelocitiesOf(segment.sightings);
    for (std::size_t now = 0, later = 0; now < all.size(); ++now) {
      while (later < all.size() && all[later].time - all[now].time < kPersistenceLag) ++later;
      if (later == all.size()) break;
      if (all[later].time - all[now].time > kPersistenceLag + kTolerance * kSpan) continue;
      const Vec2d &u = all[now].ray, &v = all[later].ray;
      products += u.x * v.x + u.y * v.y;
      squares +=
          0.5 * (u.x * u.x + u.y * u.y - all[now].noise + v.x * v.x + v.y * v.y - all[later].noise);
      ++pairs;
    }
  }
  if (pairs < kFewest || !(squares > 0)) return 1;
  return std::clamp(products / squares, -1.0, 1.0);
}

}  // namespace flocklift
