// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/persistence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace flocklift {
namespace {

constexpr double kSpan = 0.25;       // of a velocity [s]
constexpr double kTolerance = 0.25;  // of spans and lags, as a share of the span
constexpr double kEnough = 10;       // of all animals together [s]
constexpr double kSure = 2;          // of the least noise of an animal's sightings

struct Velocity {
  double time = 0;   // at the beginning
  Vec2d ray;         // [1/s]
  double noise = 0;  // of |ray|^2
};

std::vector<Velocity> VelocitiesOf(const std::vector<Sighting>& sightings) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sighting& seen : sightings) least = std::min(least, seen.ray_sd);
  std::vector<Sighting> s;  // those that are sure
  for (const Sighting& seen : sightings) {
    if (seen.ray_sd <= kSure * least) s.push_back(seen);
  }
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

// Of one animal, and for how long it was seen so.
struct Memory {
  double persistence = 1, seconds = 0;
};

Memory MemoryOf(const Segment& segment) {
  const std::vector<Velocity> all = VelocitiesOf(segment.sightings);
  double products = 0, squares = 0, noise = 0;
  Memory memory;
  for (std::size_t now = 0, later = 0; now < all.size(); ++now) {
    while (later < all.size() && all[later].time - all[now].time < kPersistenceLag) ++later;
    if (later == all.size()) break;
    if (all[later].time - all[now].time > kPersistenceLag + kTolerance * kSpan) continue;
    const Vec2d &u = all[now].ray, &v = all[later].ray;
    products += u.x * v.x + u.y * v.y;
    squares += 0.5 * (u.x * u.x + u.y * u.y + v.x * v.x + v.y * v.y);
    noise += 0.5 * (all[now].noise + all[later].noise);
    memory.seconds += now == 0 ? 0 : std::min(kSpan, all[now].time - all[now - 1].time);
  }
  // Of what hardly moves there is nothing to tell.
  if (squares < 2 * noise || !(squares > 0)) return {};
  memory.persistence = std::clamp(products / (squares - noise), -1.0, 1.0);
  return memory;
}

}  // namespace

double PersistenceOf(const std::vector<Segment>& segments) {
  std::vector<Memory> memories;
  double seconds = 0;
  for (const Segment& segment : segments) {
    const Memory memory = MemoryOf(segment);
    seconds += memory.seconds;
    if (memory.seconds > 0) memories.push_back(memory);
  }
  if (seconds < kEnough) return 1;
  std::sort(memories.begin(), memories.end(),
            [](const Memory& a, const Memory& b) { return a.persistence < b.persistence; });
  double below = 0;
  for (const Memory& memory : memories) {
    below += memory.seconds;
    if (below >= 0.5 * seconds) return memory.persistence;
  }
  return 1;
}

}  // namespace flocklift
