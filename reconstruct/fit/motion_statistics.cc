// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/motion_statistics.h"

#include <algorithm>

#include "reconstruct/metrics/flock_statistics.h"
#include "reconstruct/metrics/order_statistics.h"

namespace flocklift {
namespace {

constexpr double kStill = 1e-3;  // an animal slower than this has no direction [m/s]

const Vec3d* Find(const FramePositions& frame, Id id) {
  const auto found = std::lower_bound(frame.id.begin(), frame.id.end(), id);
  if (found == frame.id.end() || *found != id) return nullptr;
  return &frame.position[static_cast<std::size_t>(found - frame.id.begin())];
}

}  // namespace

std::size_t FullestFrame(const std::vector<FramePositions>& frames) {
  const auto fullest =
      std::max_element(frames.begin(), frames.end(),
                       [](const auto& a, const auto& b) { return a.id.size() < b.id.size(); });
  return static_cast<std::size_t>(fullest - frames.begin());
}

std::optional<MotionStatistics> ComputeMotionStatistics(std::span<const FramePositions> frames,
                                                        double dt, const TargetDistances& target) {
  std::array<std::vector<double>, kMotionStatistics.size()> values;
  auto& [speeds, accelerations, turns, distances, polarisations, ways] = values;
  for (std::size_t f = 1; f + 1 < frames.size(); ++f) {
    std::vector<Vec3d> velocities;
    for (std::size_t k = 0; k < frames[f].id.size(); ++k) {
      const Vec3d* const before = Find(frames[f - 1], frames[f].id[k]);
      const Vec3d* const after = Find(frames[f + 1], frames[f].id[k]);
      if (before == nullptr || after == nullptr) continue;
      const Vec3d v = (*after - *before) / (2 * dt);
      const Vec3d a = (*after - 2.0 * frames[f].position[k] + *before) / (dt * dt);
      speeds.push_back(Norm(v));
      accelerations.push_back(Norm(a));
      if (!(Norm(v) > kStill)) continue;
      velocities.push_back(v);
      turns.push_back(Norm(Cross(v, a)) / SquaredNorm(v));
    }
    const std::vector<double> nearest = NearestNeighbourDistances(frames[f].position);
    distances.insert(distances.end(), nearest.begin(), nearest.end());
    if (const auto polarisation = Polarisation(velocities)) polarisations.push_back(*polarisation);
  }
  for (std::size_t f = 0; target && f < frames.size(); ++f) {
    const std::vector<double> of = target(f, frames[f].position);
    ways.insert(ways.end(), of.begin(), of.end());
  }
  if (!target) ways = {0};
  MotionStatistics statistics{};
  auto out = statistics.begin();
  for (std::vector<double>& of : values) {
    if (of.empty()) return std::nullopt;
    std::sort(of.begin(), of.end());
    for (const double q : kMotionQuantiles) *out++ = QuantileOfSorted(of, q);
  }
  return statistics;
}

}  // namespace flocklift
