// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures for the tests of tracking: soft blobs on a sky with a gradient and noise.

#ifndef FLOCKLIFT_TESTS_TRACK_PICTURES_H_
#define FLOCKLIFT_TESTS_TRACK_PICTURES_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/core/vec3.h"
#include "track/detect/blob.h"
#include "track/gray_image.h"

namespace flocklift {

// A Gaussian blob: standard deviations along its axes [px], angle of the first from +u to +v.
struct SoftBlob {
  Vec2d center;
  double contrast = -100;  // at the centre [grey levels]; negative: darker than the sky
  double major_sd = 2, minor_sd = 2;
  double angle_deg = 0;
};

struct Sky {
  double level = 180;                     // at the top left [grey levels]
  double gradient_x = 0, gradient_y = 0;  // [grey levels/px]
  double noise = 0;                       // sd [grey levels]
};

inline double BlobValue(const SoftBlob& b, double x, double y) {
  const double angle = b.angle_deg * std::numbers::pi / 180;
  const double dx = x - b.center.x, dy = y - b.center.y;
  const double p = (std::cos(angle) * dx + std::sin(angle) * dy) / b.major_sd;
  const double q = (-std::sin(angle) * dx + std::cos(angle) * dy) / b.minor_sd;
  return b.contrast * std::exp(-0.5 * (p * p + q * q));
}

inline GrayImage DrawPicture(int width, int height, const Sky& sky,
                             const std::vector<SoftBlob>& blobs, std::uint64_t seed = 1) {
  std::vector<double> values(static_cast<std::size_t>(width) * height);
  Rng rng(seed);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      values[static_cast<std::size_t>(v) * width + u] =
          sky.level + sky.gradient_x * u + sky.gradient_y * v +
          (sky.noise > 0 ? sky.noise * rng.Normal() : 0);
    }
  }
  for (const SoftBlob& b : blobs) {
    const int reach = static_cast<int>(5 * std::max(b.major_sd, b.minor_sd)) + 2;
    const int cx = static_cast<int>(b.center.x), cy = static_cast<int>(b.center.y);
    for (int v = std::max(cy - reach, 0); v <= std::min(cy + reach, height - 1); ++v) {
      for (int u = std::max(cx - reach, 0); u <= std::min(cx + reach, width - 1); ++u) {
        values[static_cast<std::size_t>(v) * width + u] += BlobValue(b, u, v);
      }
    }
  }
  GrayImage image(width, height);
  for (std::size_t k = 0; k < values.size(); ++k) {
    image.pixels[k] =
        static_cast<std::uint8_t>(std::clamp(std::floor(values[k] + 0.5), 0.0, 255.0));
  }
  return image;
}

// What a detector would find of soft blobs, each alone: no picture needed.
inline BlobFrame BlobsOf(int frame, const std::vector<SoftBlob>& blobs) {
  BlobFrame found;
  found.frame = frame;
  for (const SoftBlob& b : blobs) {
    Blob blob;
    blob.center = b.center;
    blob.moments = MomentsOf({4 * b.major_sd, 4 * b.minor_sd, b.angle_deg, 0});
    blob.peak = std::abs(b.contrast);
    blob.mass = 2 * std::numbers::pi * b.major_sd * b.minor_sd * blob.peak;
    blob.snr = 50;
    const double reach = 2.5 * std::max(b.major_sd, b.minor_sd);
    blob.box = Box::Around(b.center, 2 * reach, 2 * reach);
    blob.first_pixel = static_cast<std::uint32_t>(found.pixels.size());
    for (int v = static_cast<int>(b.center.y - reach); v <= b.center.y + reach; ++v) {
      for (int u = static_cast<int>(b.center.x - reach); u <= b.center.x + reach; ++u) {
        const double value = std::abs(BlobValue(b, u, v));
        if (value < 0.05 * blob.peak) continue;
        found.pixels.push_back(
            {static_cast<float>(u), static_cast<float>(v), static_cast<float>(value)});
      }
    }
    blob.pixel_count = static_cast<std::uint32_t>(found.pixels.size()) - blob.first_pixel;
    found.blobs.push_back(blob);
  }
  return found;
}

// Two soft blobs that are found as one.
inline Blob Merged(const BlobFrame& two) {
  const Blob &a = two.blobs[0], &b = two.blobs[1];
  Blob blob = a;
  blob.mass = a.mass + b.mass;
  const double w = b.mass / blob.mass;
  blob.center = {a.center.x + w * (b.center.x - a.center.x),
                 a.center.y + w * (b.center.y - a.center.y)};
  blob.pixel_count = a.pixel_count + b.pixel_count;
  return blob;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_TRACK_PICTURES_H_
