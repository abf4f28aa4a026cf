// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What detection finds in one frame: connected patches that stand out from their surroundings.

#ifndef FLOCKLIFT_TRACK_DETECT_BLOB_H_
#define FLOCKLIFT_TRACK_DETECT_BLOB_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/vec3.h"
#include "track/detect/similarity.h"

namespace flocklift {

// Second central moments [px^2].
struct Moments {
  double xx = 0, xy = 0, yy = 0;
};

struct Edges {
  bool left = false, top = false, right = false, bottom = false;

  bool any() const { return left || top || right || bottom; }
};

// One pixel of a blob: how much it differs from the background [grey levels], positive.
struct BlobPixel {
  float x = 0, y = 0, contrast = 0;
};

struct Blob {
  Vec2d center;      // contrast-weighted [px]
  Moments moments;   // contrast-weighted, of the pixels as squares (1/12 included)
  double mass = 0;   // sum of the contrast [grey levels px^2]
  double peak = 0;   // largest contrast, lightly smoothed [grey levels]
  double snr = 0;    // peak over the local noise
  Box box;           // of the outline, to a fraction of a pixel (outline.h)
  bool cut = false;  // at a saddle: a part of a larger patch
  Edges edges;       // of the picture that it touches: there is more of it outside
  std::uint32_t first_pixel = 0, pixel_count = 0;  // in BlobFrame::pixels; none: not known
};

struct BlobFrame {
  int frame = 0;
  std::vector<Blob> blobs;
  std::vector<BlobPixel> pixels;
  int specks = 0;               // that stood out but had too few pixels for a blob
  Similarity world_from_image;  // of the camera's motion (camera_motion.h)
};

// A pixel is a square: so its moments count it, and so the camera has summed the light of it. What
// that adds to an animal's own moments [px^2] (Sheppard, Proc. London Math. Soc. 29, 1898).
inline constexpr double kPixelSquares = 2.0 / 12;

// 4 standard deviations along the axes, of the animal: without the squares of pixels, and not below
// those of one.
inline Shape ShapeOf(const Moments& m, double area) {
  constexpr double kLeast = 1.0 / 12;
  const double mean = 0.5 * (m.xx + m.yy) - kPixelSquares, half = 0.5 * (m.xx - m.yy);
  const double root = std::sqrt(half * half + m.xy * m.xy);
  double angle = 0.5 * std::atan2(2 * m.xy, m.xx - m.yy) * 180 / std::numbers::pi;
  if (angle < 0) angle += 180;
  if (angle >= 180) angle -= 180;
  return {4 * std::sqrt(std::max(mean + root, kLeast)),
          4 * std::sqrt(std::max(mean - root, kLeast)), angle, area};
}

// The inverse of ShapeOf, where no axis was below the least.
inline Moments MomentsOf(const Shape& shape) {
  const double a = shape.major * shape.major / 16 + kPixelSquares;
  const double b = shape.minor * shape.minor / 16 + kPixelSquares;
  const double angle = shape.angle_deg * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  return {a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_BLOB_H_
