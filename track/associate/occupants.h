// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which of the animals that are predicted inside a blob it does show: those by which its mass,
// centre and second moments are likeliest. A set of animals k costs, but for a constant,
//   1/2 (ln(mass / M) / 0.4)^2 + |centre - c|^2 / (2 s) + ln s + 4 KL(moments || S),
// each part bounded. c and S are centre and second moments of the animals where they are predicted,
// weighed by mass; s is the variance of that centre per axis; M is their mass together, less what
// they hide of each other.

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_OCCUPANTS_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_OCCUPANTS_H_

#include <cstddef>
#include <span>
#include <vector>

#include "track/associate/share_blob.h"
#include "track/detect/blob.h"

namespace flocklift {

inline constexpr double kLogMassSd = 0.4;  // of an animal's mass from frame to frame

// -ln likelihood of a mass when another was expected, bounded.
double MassCost(double mass, double expected);

// -ln likelihood that the blob shows exactly these animals, at least one.
double OccupantsCost(const Blob& blob, std::span<const Expectation> animals);

// The indices, in increasing order, of those that the blob shows: all but those without whom it is
// clearly likelier, at least one.
std::vector<std::size_t> FindOccupants(const Blob& blob, std::span<const Expectation> animals);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_OCCUPANTS_H_
