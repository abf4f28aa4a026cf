// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// BGR to planar YUV 4:2:0, BT.601 limited range, as players assume of films without a tag:
//   Y = 16 + (65.481 R + 128.553 G + 24.966 B) / 255
//   U = 128 + (-37.797 R - 74.203 G + 112.0 B) / 255
//   V = 128 + (112.0 R - 93.786 G - 18.214 B) / 255
// U and V of the mean of 2 x 2 pixels. Integers only: the same bytes on every machine.

#ifndef FLOCKLIFT_SIMULATE_MEDIA_YUV420_H_
#define FLOCKLIFT_SIMULATE_MEDIA_YUV420_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "simulate/core/image.h"

namespace flocklift {

// Where the three planes lie; strides in bytes.
struct Yuv420View {
  std::array<std::uint8_t*, 3> plane;
  std::array<std::ptrdiff_t, 3> stride;
};

// Y has the image's size rounded up to even (the last column or row repeats), U and V half of it.
void ConvertToYuv420(const Image& image, const Yuv420View& out);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_MEDIA_YUV420_H_
