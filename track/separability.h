// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether animals can be told from each other at all. Where they are dense and small, the next
// frame's nearest sighting is often another animal's, and no method gives them identities. The
// measure is the share of sightings that lie on unmistakable paths (motion_noise.h), each other's
// nearest and twice as near as the next one, over some frames: near 1 for birds far apart, below
// kLeastSeparable where linking would be guessing.

#ifndef FLOCKLIFT_TRACK_SEPARABILITY_H_
#define FLOCKLIFT_TRACK_SEPARABILITY_H_

#include <span>
#include <string>

#include "track/detect/blob.h"

namespace flocklift {

inline constexpr double kLeastSeparable = 0.2;

struct Separability {
  double share = 1;             // of the sightings on unmistakable paths
  double blobs_per_frame = 0;   // mean
  double specks_per_frame = 0;  // mean, of what is too small for a blob
  bool is_enough = true;        // to give identities
};

// `frames` are consecutive. Few animals, or few frames, are always enough.
Separability MeasureSeparability(std::span<const BlobFrame> frames);

// One sentence for a person.
std::string WhyDeclined(const Separability& separability);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_SEPARABILITY_H_
