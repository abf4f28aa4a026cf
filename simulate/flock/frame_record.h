// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Turns the states of a flock, one a frame, into trajectories, one an animal. States are kept until
// there are enough of them and then spread in one pass: to touch every trajectory in every frame
// would throw what the next steps need out of the processor's caches.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_FRAME_RECORD_H_
#define FLOCKLIFT_SIMULATE_FLOCK_FRAME_RECORD_H_

#include <cstddef>
#include <vector>

#include "simulate/core/trajectory.h"

namespace flocklift {

class FrameRecord {
 public:
  // Animal k of every state is trajectory k of `truth`, which outlives this.
  explicit FrameRecord(Trajectories* truth) : truth_(truth) {}

  // Frames ascend. Throws std::invalid_argument for a state of other animals.
  void Add(int frame, FlockState state);

  // Appends what has been kept so far; until then it is not in the trajectories.
  void Flush();

 private:
  struct Frame {
    int number;
    FlockState state;
  };

  Trajectories* truth_;
  std::vector<Frame> frames_;
  std::size_t points_ = 0;  // in them
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_FRAME_RECORD_H_
