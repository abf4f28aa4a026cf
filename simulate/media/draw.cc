// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

namespace flocklift {
namespace {

void Blend(Color color, double opacity, std::uint8_t* bgr) {
  const auto mix = [&](std::uint8_t below, std::uint8_t above) {
    return static_cast<std::uint8_t>(std::lround(below + (above - below) * opacity));
  };
  bgr[0] = mix(bgr[0], color.blue);
  bgr[1] = mix(bgr[1], color.green);
  bgr[2] = mix(bgr[2], color.red);
}

// The whole pixels of [low, high], cut to [0, size).
struct PixelSpan {
  int begin, end;
  PixelSpan(double low, double high, int size)
      : begin(static_cast<int>(std::clamp(std::ceil(low), 0.0, double(size)))),
        end(static_cast<int>(std::clamp(std::floor(high) + 1, 0.0, double(size)))) {}
};

}  // namespace

Color ColorOfId(Id id) {
  // Steps of the golden ratio around the colour circle keep neighbours in number far apart.
  const double turns = 0.61803398874989485 * static_cast<double>(id % 1'000'003);
  const double hue = 6 * (turns - std::floor(turns));
  const auto channel = [&](double peak) {
    const double distance = std::abs(std::remainder(hue - peak, 6.0));
    return static_cast<std::uint8_t>(std::lround(70 + 185 * std::clamp(2 - distance, 0.0, 1.0)));
  };
  return {.blue = channel(4), .green = channel(2), .red = channel(0)};
}

void DrawLine(const Vec2d& from, const Vec2d& to, Color color, double thickness, double opacity,
              Image* image) {
  const double reach = 0.5 * thickness + 0.5;  // where the coverage has fallen to 0
  const double dx = to.x - from.x, dy = to.y - from.y;
  const double squared_length = dx * dx + dy * dy;
  if (!std::isfinite(squared_length)) return;
  const PixelSpan rows(std::min(from.y, to.y) - reach, std::max(from.y, to.y) + reach,
                       image->height);
  for (int v = rows.begin; v < rows.end; ++v) {
    double low = std::min(from.x, to.x) - reach, high = std::max(from.x, to.x) + reach;
    if (std::abs(dy) > 1e-9) {  // the part of the row that the strip crosses
      const double middle = from.x + (v - from.y) * dx / dy;
      const double half = reach * std::sqrt(squared_length) / std::abs(dy);
      low = std::max(low, middle - half);
      high = std::min(high, middle + half);
    }
    // Round ends reach beyond the strip by no more than their radius.
    const PixelSpan columns(low - reach, high + reach, image->width);
    for (int u = columns.begin; u < columns.end; ++u) {
      const double along =
          squared_length > 0
              ? std::clamp(((u - from.x) * dx + (v - from.y) * dy) / squared_length, 0.0, 1.0)
              : 0;
      const double distance = std::hypot(u - from.x - along * dx, v - from.y - along * dy);
      const double cover = std::clamp(reach - distance, 0.0, std::min(1.0, thickness));
      if (cover > 0) Blend(color, opacity * cover, image->Row(v) + 3 * u);
    }
  }
}

void DrawBox(const Box& box, Color color, double thickness, Image* image) {
  const std::array<Vec2d, 4> corner{{{box.left, box.top},
                                     {box.left + box.width, box.top},
                                     {box.left + box.width, box.top + box.height},
                                     {box.left, box.top + box.height}}};
  for (std::size_t k = 0; k < 4; ++k) {
    DrawLine(corner[k], corner[(k + 1) % 4], color, thickness, 1, image);
  }
}

void DrawDot(const Vec2d& center, double radius, Color color, Image* image) {
  DrawLine(center, center, color, 2 * radius, 1, image);
}

void DrawTrail(std::span<const Vec2d> points, Color color, double thickness, Image* image) {
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double opacity = static_cast<double>(k) / static_cast<double>(points.size() - 1);
    DrawLine(points[k - 1], points[k], color, thickness, opacity, image);
  }
}

void DrawText(const Vec2d& lower_left, std::string_view text, Color color, double height,
              Image* image) {
  constexpr double kCapitalHeight = 21;  // of OpenCV's simplex font at scale 1 [px]
  if (!(std::abs(lower_left.x) < 1e6 && std::abs(lower_left.y) < 1e6)) return;
  cv::Mat picture(image->height, image->width, CV_8UC3, image->bgr.data());
  const double scale = height / kCapitalHeight;
  const int stroke = std::max(1, static_cast<int>(std::lround(height / 10)));
  const cv::Point origin(static_cast<int>(std::lround(lower_left.x)),
                         static_cast<int>(std::lround(lower_left.y)));
  const std::string line(text);
  cv::putText(picture, line, origin, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar(20, 20, 20),
              stroke + 2, cv::LINE_AA);
  cv::putText(picture, line, origin, cv::FONT_HERSHEY_SIMPLEX, scale,
              cv::Scalar(color.blue, color.green, color.red), stroke, cv::LINE_AA);
}

}  // namespace flocklift
