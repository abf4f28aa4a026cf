// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What goes wrong with whole tracks, as opposed to single rows (ObservationNoise): animals that are
// lost for a while, sizes that are off for seconds, and names that change hands.

#ifndef FLOCKLIFT_SIMULATE_TRACK_FAULTS_H_
#define FLOCKLIFT_SIMULATE_TRACK_FAULTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/options.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct TrackFaults {
  double gaps = 0;             // that begin, per 1000 rows
  double gap_length = 8;       // mean of an exponential distribution [frames]
  double size_drift_sd = 0;    // of the logarithm of the size: an Ornstein-Uhlenbeck process
  double size_drift_time = 2;  // of its correlation [s]
  double switches = 0;         // identities that change hands, per 1000 rows
};

template <typename Visitor>
void Describe(Visitor& visit, TrackFaults& o) {
  visit("gaps", o.gaps, {.low = 0, .high = 1000}, "", "losses of an animal per 1000 rows");
  visit("gap-length", o.gap_length, {.low = 1, .high = 1e6}, "", "mean frames of such a loss");
  visit("size-drift-sd", o.size_drift_sd, {.low = 0, .high = 2}, "", "lasting errors of log size");
  visit("size-drift-time", o.size_drift_time, {.low = 1e-3, .high = 1e6}, "s",
        "how long they last");
  visit("switches", o.switches, {.low = 0, .high = 1000}, "", "identity switches per 1000 rows");
}

// Gaps and lasting errors of size. What befalls an animal depends on (seed, id, frame) alone.
Tracks SynthesizeFaults(const TrackFaults& faults, std::uint64_t seed, double fps,
                        const Tracks& tracks);

// From `frame` on, the animals a and b carry the name that the other one had until then.
struct IdentitySwitch {
  int frame = 0;
  Id a = 0, b = 0;
};

// Any row may be where its animal and the nearest in the image change names.
std::vector<IdentitySwitch> SynthesizeSwitches(const TrackFaults& faults, std::uint64_t seed,
                                               const Tracks& tracks);

// The same rows under the names that the animals then have: tracks, or the truth that tracks with
// such switches are scored against.
Tracks WithSwitches(std::span<const IdentitySwitch> switches, const Tracks& tracks);
Trajectories WithSwitches(std::span<const IdentitySwitch> switches,
                          const Trajectories& trajectories);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_TRACK_FAULTS_H_
