// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How long animals keep their velocity, told from the image alone. With velocities u of rays over a
// quarter of a second, pooled over all animals,
//   persistence = sum u(t) . u(t + T) / sum (|u(t)|^2 + |u(t + T)|^2) / 2,   T = 1/2 s,
// noise of the image positions taken out below. Birds in flocks turn by less than a radian in that
// time and come to 0.8 and more; insects in a swarm (moths about a lamp, flies in a box) have
// forgotten where they flew.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_PERSISTENCE_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_PERSISTENCE_H_

#include <vector>

#include "reconstruct/initialize/segments.h"

namespace flocklift {

inline constexpr double kPersistenceLag = 0.5;  // T [s]

// -1 to 1; 1 where the tracks are too short to tell.
double PersistenceOf(const std::vector<Segment>& segments);

// Whether animals of this persistence are to be taken to keep no speed.
constexpr bool IsErratic(double persistence) { return persistence < 0.5; }

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_PERSISTENCE_H_
