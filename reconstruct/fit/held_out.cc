// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/held_out.h"

#include <utility>

namespace flocklift {

int FirstHeldOut(const Trajectories& flock, double share) {
  const FrameSpan span = SpanOf(flock);
  return span.last - static_cast<int>(share * (span.last - span.first + 1)) + 1;
}

Trajectories BeforeFrame(const Trajectories& flock, int split) {
  Trajectories early = flock;
  early.trajectories.clear();
  for (const Trajectory& trajectory : flock.trajectories) {
    Trajectory some = trajectory;
    std::erase_if(some.points, [&](const TrajectoryPoint& p) { return p.frame >= split; });
    if (!some.points.empty()) early.trajectories.push_back(std::move(some));
  }
  return early;
}

}  // namespace flocklift
