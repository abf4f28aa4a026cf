// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/yuv420.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

// The equations of the header in floating point, pixel by pixel, for random pictures of even and
// odd sizes, on rows longer than the picture.
TEST(Yuv420Test, AgreesWithTheEquations) {
  for (const auto& [width, height] : {std::pair{8, 6}, std::pair{37, 23}, std::pair{1, 1}}) {
    Image image(width, height);
    Rng rng(7, static_cast<std::uint64_t>(width));
    for (auto& value : image.bgr) value = static_cast<std::uint8_t>(rng.Below(256));
    const int even_width = width + width % 2, even_height = height + height % 2;
    const int stride = even_width + 5;
    std::vector<std::uint8_t> y(stride * even_height), u(stride * even_height), v(u);
    ConvertToYuv420(image, {{y.data(), u.data(), v.data()}, {stride, stride, stride}});

    const auto at = [&](int row, int column, int channel) {
      return double(
          image.Row(std::min(row, height - 1))[3 * std::min(column, width - 1) + channel]);
    };
    for (int row = 0; row < even_height; ++row) {
      for (int column = 0; column < even_width; ++column) {
        const double b = at(row, column, 0), g = at(row, column, 1), r = at(row, column, 2);
        EXPECT_NEAR(y[row * stride + column], 16 + (65.481 * r + 128.553 * g + 24.966 * b) / 255,
                    0.51);
      }
    }
    for (int row = 0; row < even_height; row += 2) {
      for (int column = 0; column < even_width; column += 2) {
        const auto mean = [&](int c) {
          return (at(row, column, c) + at(row, column + 1, c) + at(row + 1, column, c) +
                  at(row + 1, column + 1, c)) /
                 4;
        };
        const double b = mean(0), g = mean(1), r = mean(2);
        EXPECT_NEAR(u[row / 2 * stride + column / 2],
                    128 + (-37.797 * r - 74.203 * g + 112.0 * b) / 255, 0.51);
        EXPECT_NEAR(v[row / 2 * stride + column / 2],
                    128 + (112.0 * r - 93.786 * g - 18.214 * b) / 255, 0.51);
      }
    }
  }
}

TEST(Yuv420Test, GreysHaveNoColour) {
  Image image(2, 2);
  for (int level : {0, 1, 128, 255}) {
    std::fill(image.bgr.begin(), image.bgr.end(), static_cast<std::uint8_t>(level));
    std::uint8_t y[4], u[1], v[1];
    ConvertToYuv420(image, {{y, u, v}, {2, 1, 1}});
    EXPECT_EQ(u[0], 128);
    EXPECT_EQ(v[0], 128);
  }
}

}  // namespace
}  // namespace flocklift
