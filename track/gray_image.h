// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One channel of 8 bits in memory: what detection works on.

#ifndef FLOCKLIFT_TRACK_GRAY_IMAGE_H_
#define FLOCKLIFT_TRACK_GRAY_IMAGE_H_

#include <cstdint>
#include <vector>

namespace flocklift {

// Rows from the top, no padding.
struct GrayImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  // width * height

  GrayImage() = default;
  GrayImage(int width_px, int height_px)
      : width(width_px),
        height(height_px),
        pixels(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)) {}

  std::uint8_t* Row(int v) { return pixels.data() + static_cast<std::size_t>(v) * width; }
  const std::uint8_t* Row(int v) const {
    return pixels.data() + static_cast<std::size_t>(v) * width;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_GRAY_IMAGE_H_
