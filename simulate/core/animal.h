// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The body of one animal of a simulation: what the renderer draws and what the true boxes enclose.

#ifndef FLOCKLIFT_SIMULATE_CORE_ANIMAL_H_
#define FLOCKLIFT_SIMULATE_CORE_ANIMAL_H_

#include "simulate/core/observations.h"

namespace flocklift {

struct Animal {
  Id id = 0;
  double wingspan = 0.7;      // tip to tip with level wings [m]
  double body_length = 0.35;  // [m]
  double wingbeat_hz = 5;     // [1/s]
  double wingbeat_phase = 0;  // at time 0 [rad]
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_ANIMAL_H_
