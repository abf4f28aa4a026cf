// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What relative depth will rest on, told from the image alone, before anything is solved. Along a
// path that turns, perspective compares near with far; how far the motion turns in the image says
// how much of that there is. A straight transit has next to none: there, and in short tracks, only
// equal speeds (image speed is v/z) and apparent size tell who is nearer; and only size where
// animals keep no speed.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_OBSERVABILITY_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_OBSERVABILITY_H_

#include <string>

#include "reconstruct/initialize/segments.h"
#include "reconstruct/knowledge.h"

namespace flocklift {

struct Observability {
  double duration = 0;      // median of the segments [s]
  double image_turn = 0;    // median angle by which the image motion of a segment turns [rad]
  double speed_change = 0;  // median of log(fastest over slowest) in the image, along a segment
  double sizes = 0;         // share of the sightings that have one
  bool erratic = false;     // animals keep no speed (persistence.h)
};

Observability LookAhead(const Segments& segments);

// "straight transit: relative depth rests on ...". One line.
std::string Describe(const Observability& observability, const Knowledge& knowledge);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_OBSERVABILITY_H_
