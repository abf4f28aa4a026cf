// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Luma of limited range spread to all of a byte, so that black is 0 and white 255:
//   (Y - 16) 255 / 219, rounded, and cut off at both ends,
// here as t + (12 t + 36) / 73 with t = Y - 16 in whole numbers of 16 bits, which is the same and
// goes by many pixels at a time.

#ifndef FLOCKLIFT_TRACK_SPREAD_LUMA_H_
#define FLOCKLIFT_TRACK_SPREAD_LUMA_H_

#include <cstdint>

namespace flocklift::internal {

inline void SpreadLuma(const std::uint8_t* from, int count, std::uint8_t* to) {
  for (int u = 0; u < count; ++u) {
    const std::uint8_t least = from[u] < 16 ? std::uint8_t{16} : from[u];
    const auto t = static_cast<std::uint16_t>((least > 235 ? 235 : least) - 16);
    const auto rounded = static_cast<std::uint16_t>(12 * t + 36);
    to[u] = static_cast<std::uint8_t>(t + static_cast<std::uint16_t>(rounded / 73));
  }
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_SPREAD_LUMA_H_
