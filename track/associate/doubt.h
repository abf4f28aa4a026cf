// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A place in a track where a decision was a close one: what a person should look at.

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_DOUBT_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_DOUBT_H_

#include "simulate/core/vec3.h"

namespace flocklift {

enum class DoubtKind {
  kSwap,   // two animals left a shared blob, perhaps as each other
  kMerge,  // one was hidden by another for long
  kJoin,   // a gap was bridged, perhaps to another animal
  kJump,   // a step that the animal's motion did not announce
  kBreak,  // a track begins or ends where nothing hides the animal
};

struct Doubt {
  DoubtKind kind = DoubtKind::kSwap;
  int first_frame = 0, last_frame = 0;
  Vec2d position;     // [px]
  double chance = 0;  // that the decision was wrong, as far as the costs tell
};

inline constexpr double kLeastDoubt = 0.05;  // less is not worth a look

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_DOUBT_H_
