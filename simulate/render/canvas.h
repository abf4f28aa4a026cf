// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A frame while it is painted: background, then opaque surfaces, then everything that covers a
// pixel in part, from far to near, then the sensor. A pixel is kept as two colours, that of the
// samples which a surface covers and that of the others, so that an animal behind the edge of an
// obstacle darkens only what the obstacle leaves open:
//   pixel = k C_surface + (1 - k) C_open,   k the share of its samples that are covered.
// What is laid over at depth z with share c changes C_open by c (tone - C_open), and C_surface by
// c f (tone - C_surface), f the share of the covered samples whose surface is farther than z.

#ifndef FLOCKLIFT_SIMULATE_RENDER_CANVAS_H_
#define FLOCKLIFT_SIMULATE_RENDER_CANVAS_H_

#include <array>
#include <cstdint>
#include <vector>

#include "simulate/core/image.h"
#include "simulate/core/vec3.h"
#include "simulate/render/coverage.h"
#include "simulate/render/depth_buffer.h"

namespace flocklift {

// What covers: its colour (blue green red, in 1 / Canvas::kUnit grey levels), how far away it is,
// and how much of the ground it hides where it covers a pixel wholly.
struct Paint {
  std::array<std::int32_t, 3> tone{};
  double depth = 0;    // camera-frame z [m]
  double opacity = 1;  // in [0, 1]
};

class Canvas {
 public:
  static constexpr int kUnit = 64;  // colours are kept as 1/64 of a grey level

  Canvas(int width, int height);

  // Of the open colour: the background is written here first, 3 x width values a row.
  std::int16_t* Row(int v) { return open_.data() + Offset(v); }

  // Takes over the surfaces, seen through haze: exp(-z / haze) of their contrast with the
  // background is left (haze = 0: all). The buffer must live as long as it is painted over.
  void Place(const DepthBuffer* surfaces, double haze);

  void LayOver(const CoverageMask& mask, const Paint& paint);

  // A point that darkens `area` square pixels in all, spread over four pixels as the lens does
  // (coverage.h). `grain` makes the rounding of faint shares fair: equal grains, equal bytes.
  void Dab(const Vec2d& pixel, double area, const Paint& paint, std::uint32_t grain);

  // Row v in whole grey levels, noise added (may be null).
  void Develop(int v, const std::int16_t* noise, std::uint8_t* out);

 private:
  std::size_t Offset(int v) const {
    return 3 * static_cast<std::size_t>(v) * static_cast<std::size_t>(width_);
  }
  void Blend(int u, int v, std::int32_t share, std::int32_t rounding, const Paint& paint,
             float nearness);

  int width_, height_;
  std::vector<std::int16_t> open_;
  std::vector<std::int16_t> covered_;  // where surfaces are; empty without any
  const DepthBuffer* surfaces_ = nullptr;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_CANVAS_H_
