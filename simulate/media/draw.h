// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drawings over a picture: anti-aliased lines, boxes, trails and small text with sub-pixel
// positions [px], in colours that follow the identity. What lies outside the picture is cut off.

#ifndef FLOCKLIFT_SIMULATE_MEDIA_DRAW_H_
#define FLOCKLIFT_SIMULATE_MEDIA_DRAW_H_

#include <cstdint>
#include <span>
#include <string_view>

#include "simulate/core/image.h"
#include "simulate/core/observations.h"
#include "simulate/core/vec3.h"

namespace flocklift {

struct Color {
  std::uint8_t blue = 0, green = 0, red = 0;

  friend constexpr bool operator==(const Color&, const Color&) = default;
};

// The colour of an identity, always the same: bright, and far from those of the next ids.
Color ColorOfId(Id id);

// A segment with round ends; opacity in [0, 1].
void DrawLine(const Vec2d& from, const Vec2d& to, Color color, double thickness, double opacity,
              Image* image);

void DrawBox(const Box& box, Color color, double thickness, Image* image);

// A filled disc.
void DrawDot(const Vec2d& center, double radius, Color color, Image* image);

// A path from the oldest point to the newest, which fades towards the oldest.
void DrawTrail(std::span<const Vec2d> points, Color color, double thickness, Image* image);

// ASCII text whose capital letters are `height` tall, from its lower left corner on, with a dark
// rim that keeps it readable on any ground.
void DrawText(const Vec2d& lower_left, std::string_view text, Color color, double height,
              Image* image);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_MEDIA_DRAW_H_
