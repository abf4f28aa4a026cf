// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/join_cost.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "track/predict/smoother.h"

namespace flocklift {
namespace {

std::vector<MotionState> StatesOf(std::span<const TrackPoint> sightings, double size,
                                  const MotionNoise& noise) {
  std::vector<Measurement> measurements;
  for (const TrackPoint& s : sightings) {
    measurements.push_back({s.frame, s.position, s.variance, s.agility});
  }
  return Smooth(measurements, noise.ProcessVariance(size), noise.speed_sd);
}

}  // namespace

JoinCost CostOfJoin(const MotionState& end, const MotionState& begin, double q, int frames) {
  MotionState ahead = end;
  Predict(&ahead, q, frames);
  const double c00 = ahead.pp + begin.pp, c01 = ahead.pv + begin.pv, c11 = ahead.vv + begin.vv;
  const double det = c00 * c11 - c01 * c01;
  const auto squared = [&](double dp, double dv) {
    return (c11 * dp * dp - 2 * c01 * dp * dv + c00 * dv * dv) / det;
  };
  const double d2 =
      squared(begin.position.x - ahead.position.x, begin.velocity.x - ahead.velocity.x) +
      squared(begin.position.y - ahead.position.y, begin.velocity.y - ahead.velocity.y);
  return {d2, 0.5 * d2 + 2 * std::log(2 * std::numbers::pi) + std::log(det)};
}

MotionState StateAtLast(std::span<const TrackPoint> sightings, double size,
                        const MotionNoise& noise) {
  return StatesOf(sightings, size, noise).back();
}

MotionState StateAtFirst(std::span<const TrackPoint> sightings, double size,
                         const MotionNoise& noise) {
  return StatesOf(sightings, size, noise).front();
}

}  // namespace flocklift
