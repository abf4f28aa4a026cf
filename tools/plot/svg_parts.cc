// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/svg_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/plot/markup.h"

namespace flocklift {
namespace {

constexpr double kCharacter = 6.8;  // mean width [px]

}  // namespace

std::string Stroke(const PlotStyle& style) {
  std::string attributes = fmt::format(" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"",
                                       style.color, Coordinate(style.width));
  if (style.opacity < 1) attributes += fmt::format(" stroke-opacity=\"{:.2g}\"", style.opacity);
  if (!style.dash.empty()) attributes += fmt::format(" stroke-dasharray=\"{}\"", style.dash);
  return attributes;
}

std::string Fill(const PlotStyle& style) {
  std::string attributes = fmt::format(" fill=\"{}\"", style.color);
  if (style.opacity < 1) attributes += fmt::format(" fill-opacity=\"{:.2g}\"", style.opacity);
  return attributes;
}

std::string PathOf(const std::vector<Vec2d>& points) {
  std::string path;
  double x = 0, y = 0;
  for (const Vec2d& p : points) {
    // Steps between rounded positions, so that rounding never adds up.
    const double next_x = std::round(p.x * 10) / 10, next_y = std::round(p.y * 10) / 10;
    if (path.empty()) {
      path = fmt::format("M{} {}l", Coordinate(next_x), Coordinate(next_y));
    } else {
      const std::string dx = Coordinate(next_x - x), dy = Coordinate(next_y - y);
      if (dx == "0" && dy == "0") continue;
      if (path.back() != 'l' && dx.front() != '-') path += ' ';
      path += dx;
      if (dy.front() != '-') path += ' ';
      path += dy;
    }
    x = next_x;
    y = next_y;
  }
  if (!path.empty() && path.back() == 'l') path += "0 0";
  return path;
}

double TextWidth(std::string_view text) {  // of characters, not bytes
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  });
  return kCharacter * static_cast<double>(characters);
}

std::string PixelText(double x, double y, std::string_view anchor, std::string_view kind,
                      std::string_view text) {
  return fmt::format(
      "<text x=\"{}\" y=\"{}\" class=\"{}\"{}>{}</text>", Coordinate(x), Coordinate(y), kind,
      anchor.empty() ? "" : fmt::format(" text-anchor=\"{}\"", anchor), EscapeMarkup(text));
}

}  // namespace flocklift
