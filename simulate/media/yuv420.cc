// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/yuv420.h"

#include <algorithm>
#include <vector>

namespace flocklift {
namespace {

// The upper half of a product of 16 bits: one SIMD instruction.
std::uint16_t High(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint16_t>((static_cast<std::uint32_t>(a) * b) >> 16);
}

// In units of 2^-8; the coefficients in units of 2^-16, half a unit for what the products lose.
std::uint8_t Luma(std::uint8_t b, std::uint8_t g, std::uint8_t r) {
  const auto scaled = [](std::uint8_t x) { return static_cast<std::uint16_t>(x << 8); };
  const auto sum = static_cast<std::uint16_t>(High(scaled(b), 6416) + High(scaled(g), 33039) +
                                              High(scaled(r), 16829) + (16 << 8) + 128 + 1);
  return static_cast<std::uint8_t>(sum >> 8);
}

// Of sums of four pixels, in units of 2^-18.
std::uint8_t BlueDifference(std::int32_t b4, std::int32_t g4, std::int32_t r4) {
  return static_cast<std::uint8_t>(
      (28784 * b4 - 19070 * g4 - 9714 * r4 + (128 << 18) + (1 << 17)) >> 18);
}
std::uint8_t RedDifference(std::int32_t b4, std::int32_t g4, std::int32_t r4) {
  return static_cast<std::uint8_t>(
      (28784 * r4 - 24103 * g4 - 4681 * b4 + (128 << 18) + (1 << 17)) >> 18);
}

}  // namespace

void ConvertToYuv420(const Image& image, const Yuv420View& out) {
  const int width = image.width + image.width % 2;
  const int pairs = width / 2;
  // Two rows apart by channel, the last column repeated: loops over them become vector code.
  std::vector<std::uint8_t> split(6 * static_cast<std::size_t>(width));
  std::uint8_t* channel[2][3];
  for (int k = 0; k < 6; ++k)
    channel[k / 3][k % 3] = split.data() + static_cast<std::size_t>(k) * width;

  for (int v = 0; v < image.height; v += 2) {
    for (int k = 0; k < 2; ++k) {
      const std::uint8_t* bgr = image.Row(std::min(v + k, image.height - 1));
      std::uint8_t *b = channel[k][0], *g = channel[k][1], *r = channel[k][2];
      for (int u = 0; u < image.width; ++u) {
        b[u] = bgr[3 * u];
        g[u] = bgr[3 * u + 1];
        r[u] = bgr[3 * u + 2];
      }
      b[width - 1] = b[image.width - 1];
      g[width - 1] = g[image.width - 1];
      r[width - 1] = r[image.width - 1];
      std::uint8_t* y = out.plane[0] + (v + k) * out.stride[0];
      for (int u = 0; u < width; ++u) y[u] = Luma(b[u], g[u], r[u]);
    }
    std::uint8_t* blue = out.plane[1] + v / 2 * out.stride[1];
    std::uint8_t* red = out.plane[2] + v / 2 * out.stride[2];
    for (int u = 0; u < pairs; ++u) {
      const auto sum = [&](int c) {
        return channel[0][c][2 * u] + channel[0][c][2 * u + 1] + channel[1][c][2 * u] +
               channel[1][c][2 * u + 1];
      };
      const int b4 = sum(0), g4 = sum(1), r4 = sum(2);
      blue[u] = BlueDifference(b4, g4, r4);
      red[u] = RedDifference(b4, g4, r4);
    }
  }
}

}  // namespace flocklift
