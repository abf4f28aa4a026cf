// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How a flock moves, in numbers that two flocks without common animals or noise can be compared by
// (after Ren, Wang, Jin, Manocha 2016, who estimate BSwarm's parameters so): quantiles of
//   speed |v| [m/s], acceleration |a| [m/s^2], turning rate |v x a| / |v|^2 [rad/s], over animals
//   and frames with v, a central differences;
//   distance to the nearest neighbour [m]; polarisation | mean v / |v| |, one a frame
//   distance to what a scene gives to fly to (target_distance.h) [m]; all 0 where there is nothing
// A quantile is moved by a few wild values no more than by any others.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_MOTION_STATISTICS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_MOTION_STATISTICS_H_

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "simulate/core/trajectory.h"

namespace flocklift {

inline constexpr std::array<std::string_view, 6> kMotionStatistics = {
    "speed",        "acceleration",   "turning_rate", "neighbour_distance",
    "polarisation", "target_distance"};
inline constexpr std::array<double, 9> kMotionQuantiles = {0.05, 0.15, 0.25, 0.4, 0.5,
                                                           0.6,  0.75, 0.85, 0.95};

// kMotionQuantiles of each of kMotionStatistics, in their order.
using MotionStatistics = std::array<double, kMotionStatistics.size() * kMotionQuantiles.size()>;

// The positions of the animals that are there in one frame, by increasing id.
struct FramePositions {
  std::vector<Id> id;
  std::vector<Vec3d> position;
};

// The first of those with most animals.
std::size_t FullestFrame(const std::vector<FramePositions>& frames);

// How far places are from what there is to fly to, in one of the frames; none in a frame that is
// not looked at.
using TargetDistances =
    std::function<std::vector<double>(std::size_t frame, const std::vector<Vec3d>& places)>;

// Frames in a row, dt apart [s]. Nothing when one has no value, as for fewer than three frames or
// two animals. Without `target` the last statistic has none.
std::optional<MotionStatistics> ComputeMotionStatistics(std::span<const FramePositions> frames,
                                                        double dt,
                                                        const TargetDistances& target = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_MOTION_STATISTICS_H_
