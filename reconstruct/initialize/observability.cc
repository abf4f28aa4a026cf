// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/observability.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "reconstruct/initialize/persistence.h"

namespace flocklift {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kStep = 0.5;  // over which motion in the image is measured [s]

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Motion {
  double turn = 0, speed_change = 0;
};

// Motion from one sighting to the next that is at least kStep later.
std::optional<Motion> MotionOf(const Segment& segment) {
  std::vector<Vec2d> velocities;
  const auto& sightings = segment.sightings;
  for (std::size_t from = 0, to = 1; to < sightings.size(); ++to) {
    const double dt = sightings[to].time - sightings[from].time;
    if (dt < kStep) continue;
    velocities.push_back({(sightings[to].ray.x - sightings[from].ray.x) / dt,
                          (sightings[to].ray.y - sightings[from].ray.y) / dt});
    from = to;
  }
  if (velocities.size() < 2) return std::nullopt;
  Motion motion;
  double slowest = 1e300, fastest = 0;
  for (const Vec2d& a : velocities) {
    const double speed = std::hypot(a.x, a.y);
    slowest = std::min(slowest, std::max(speed, 1e-12));
    fastest = std::max(fastest, speed);
    for (const Vec2d& b : velocities) {
      const double angle = std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
      motion.turn = std::max(motion.turn, std::abs(angle));
    }
  }
  motion.speed_change = std::log(std::max(fastest, slowest) / slowest);
  return motion;
}

}  // namespace

Observability LookAhead(const Segments& segments) {
  Observability result;
  std::vector<double> durations, turns, changes;
  double seen = 0, sized = 0;
  for (const Segment& segment : segments.segments) {
    durations.push_back(segment.sightings.back().time - segment.sightings.front().time);
    if (const auto motion = MotionOf(segment)) {
      turns.push_back(motion->turn);
      changes.push_back(motion->speed_change);
    }
    for (const Sighting& s : segment.sightings) sized += s.log_size ? 1 : 0;
    seen += static_cast<double>(segment.sightings.size());
  }
  result.duration = Median(durations);
  result.image_turn = Median(turns);
  result.speed_change = Median(changes);
  result.sizes = seen > 0 ? sized / seen : 0;
  result.erratic = IsErratic(segments.persistence);
  return result;
}

std::string Describe(const Observability& o, const Knowledge& knowledge) {
  constexpr double kStraight = 30 * kDegree, kShort = 1.5;
  const double kMuchFaster = std::log(2.5);
  const bool sizes = knowledge.use_size && o.sizes > 0;
  if (o.erratic) {
    const std::string flight = "erratic flight, velocities forgotten within half a second: ";
    return sizes ? flight + "relative depth rests on apparent size"
                 : flight + "nothing tells relative depth but how wide the flock is";
  }
  std::string text;
  if (o.duration < kShort) {
    text = "short tracks: relative depth rests on ";
  } else if (o.image_turn < kStraight) {
    text =
        o.speed_change < kMuchFaster
            ? "straight transit: relative depth rests on "
            : "straight flight, nearer or farther: relative depth rests on image speed along it, ";
  } else {
    text = "turning flight: relative depth rests on perspective along curved paths, ";
  }
  text += "equal speeds of the animals";
  if (sizes) text += " and apparent size";
  if (knowledge.up_in_cam) text += ", helped by level flight";
  text += " (motion in the image turns by " + std::to_string(std::lround(o.image_turn / kDegree)) +
          " degrees in a median track of " + std::to_string(std::lround(o.duration)) + " s)";
  if (!sizes && (o.duration < kShort || o.image_turn < kStraight)) {
    text += "; without sizes, expect little of the order of depths";
  }
  return text;
}

}  // namespace flocklift
