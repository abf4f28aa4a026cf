// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture in memory, as it passes between rooms.

#ifndef FLOCKLIFT_SIMULATE_CORE_IMAGE_H_
#define FLOCKLIFT_SIMULATE_CORE_IMAGE_H_

#include <cstdint>
#include <vector>

namespace flocklift {

// 8 bits a channel, blue green red interleaved, rows from the top, no padding.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bgr;  // width * height * 3

  Image() = default;
  Image(int width_px, int height_px)
      : width(width_px),
        height(height_px),
        bgr(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * 3) {}

  std::uint8_t* Row(int v) { return bgr.data() + static_cast<std::size_t>(v) * width * 3; }
  const std::uint8_t* Row(int v) const {
    return bgr.data() + static_cast<std::size_t>(v) * width * 3;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_IMAGE_H_
