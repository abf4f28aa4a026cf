// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How long an animal is along a row or a column of the picture, to a fraction of a pixel. Counting
// the pixels that stand out makes every animal about a pixel too large, small ones by a tenth and
// more: a pixel counts that an animal just touches, and lens, shutter and compression spread it.
// Of a profile, the strongest contrast in each column (or row) of a blob, an end is where it rises
// to a share of the strongest within kReach pixels inward. A share of 1/2 is right for a straight
// edge whatever spreads it, and cuts pointed wings short; 0.3 is about as much too wide at edges as
// it is too short at the tips of two kinds of drawn birds (within 1 % of their diagonal from 20 px
// on, 4 % at 9 px, where whole pixels are 6 to 9 and 29 % too many).

#ifndef FLOCKLIFT_TRACK_DETECT_OUTLINE_H_
#define FLOCKLIFT_TRACK_DETECT_OUTLINE_H_

#include <algorithm>
#include <cstddef>
#include <span>

namespace flocklift::internal {

// Ends of what is seen, in pixels from the centre of the profile's first.
struct Outline {
  double first = 0, last = 0;

  double length() const { return last - first; }
};

// `at(k)`, k = 0 .. count - 1, is a profile from outside inward, positive. How far inside its first
// pixel's centre the end is; negative: outside.
template <typename At>
double EndOfProfile(std::size_t count, const At& at) {
  constexpr float kShare = 0.3F;
  constexpr std::size_t kReach = 2;  // [px]
  for (std::size_t k = 0; k < count; ++k) {
    float strongest = at(k);
    for (std::size_t j = k + 1; j <= k + kReach && j < count; ++j) {
      strongest = std::max(strongest, at(j));
    }
    const float level = kShare * strongest;
    if (at(k) < level) continue;
    const float before = k > 0 ? at(k - 1) : 0;
    return static_cast<double>(k) - 1 + (level - before) / (at(k) - before);
  }
  return 0;
}

// `profile` is not empty.
inline Outline OutlineOf(std::span<const float> profile) {
  const std::size_t last = profile.size() - 1;
  const double begin = EndOfProfile(profile.size(), [&](std::size_t k) { return profile[k]; });
  const double end = EndOfProfile(profile.size(), [&](std::size_t k) { return profile[last - k]; });
  return {begin, static_cast<double>(last) - end};
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_DETECT_OUTLINE_H_
