// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How long animals keep their velocity, told from the image alone. With velocities u of one
// animal's ray over a quarter of a second,
//   persistence = sum u(t) . u(t + T) / sum (|u(t)|^2 + |u(t + T)|^2) / 2,   T = 1/2 s,
// noise of the image positions taken out below; for the flock, the median over animals. Birds of
// recorded and simulated flocks come to 0.8 and more; insects in a swarm (moths about a lamp, flies
// in a box) have forgotten where they flew. On a circle it is the cosine of the angle in T,
// whatever the speed: what circles at 2.1 to 4.2 rad/s is taken for an insect.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_PERSISTENCE_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_PERSISTENCE_H_

#include <vector>

#include "reconstruct/initialize/segments.h"

namespace flocklift {

inline constexpr double kPersistenceLag = 0.5;  // T [s]

// -1 to 1; 1 where there is less than ten seconds of animals that are seen to move.
double PersistenceOf(const std::vector<Segment>& segments);

// Whether animals of this persistence are to be taken to keep no speed.
constexpr bool IsErratic(double persistence) { return -0.5 < persistence && persistence < 0.5; }

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_PERSISTENCE_H_
