// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/frame_record.h"

#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr std::size_t kMostFrames = 32;
constexpr std::size_t kMostPoints = 1U << 18;  // 14 MB

}  // namespace

void FrameRecord::Add(int frame, FlockState state) {
  Check(state.size() == truth_->trajectories.size(), "a state must be of all animals");
  points_ += state.size();
  frames_.push_back({frame, std::move(state)});
  if (frames_.size() >= kMostFrames || points_ >= kMostPoints) Flush();
}

void FrameRecord::Flush() {
  for (std::size_t k = 0; k < truth_->trajectories.size(); ++k) {
    std::vector<TrajectoryPoint>& points = truth_->trajectories[k].points;
    for (const Frame& frame : frames_) {
      TrajectoryPoint point;
      point.frame = frame.number;
      point.position = frame.state.position[k];
      point.velocity = frame.state.velocity[k];
      points.push_back(point);
    }
  }
  frames_.clear();
  points_ = 0;
}

}  // namespace flocklift
