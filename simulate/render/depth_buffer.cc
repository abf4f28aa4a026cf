// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/depth_buffer.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

// A side of a triangle, from its upper end on: both triangles at a side compute the same x.
struct Side {
  Vec2d upper;
  double slope;  // of x
  double nearness, nearness_slope;

  Side(const ImageCorner& a, const ImageCorner& b) : upper(a.pixel), nearness(a.nearness) {
    const double height = b.pixel.y - a.pixel.y;
    slope = height > 0 ? (b.pixel.x - a.pixel.x) / height : 0;
    nearness_slope = height > 0 ? (b.nearness - a.nearness) / height : 0;
  }
  double At(double y) const { return upper.x + slope * (y - upper.y); }
  double NearnessAt(double y) const { return nearness + nearness_slope * (y - upper.y); }
};

bool IsAbove(const ImageCorner& a, const ImageCorner& b) {
  return a.pixel.y < b.pixel.y || (a.pixel.y == b.pixel.y && a.pixel.x < b.pixel.x);
}

// value(x, y) = at_origin + dx (x - origin.x) + dy (y - origin.y).
struct Plane {
  Vec2d origin;
  double at_origin, dx, dy;

  double At(double x, double y) const {
    return at_origin + dx * (x - origin.x) + dy * (y - origin.y);
  }
};

// ceil(x) clamped to [0, high]; std::ceil is a call on machines of old.
int CeilWithin(double x, int high) {
  if (!(x > 0)) return 0;
  if (x >= high) return high;
  const int whole = static_cast<int>(x);
  return whole + (whole < x ? 1 : 0);
}

std::uint32_t Shaded(const std::array<std::uint8_t, 3>& tone, float shade) {
  std::uint32_t packed = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float level = std::clamp(tone[c] * shade + 0.5F, 0.0F, 255.0F);
    packed |= static_cast<std::uint32_t>(level) << (8 * c);
  }
  return packed;
}

}  // namespace

DepthBuffer::DepthBuffer(int width, int height)
    : width_(width),
      height_(height),
      top_(height),
      bottom_(0),
      nearness_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * kSamples),
      tone_(nearness_.size()),
      touched_(static_cast<std::size_t>(height), Range{width, 0}) {
  Check(width > 0 && height > 0, "a depth buffer needs a size");
}

void DepthBuffer::Clear() {
  for (int v = top_; v < bottom_; ++v) {
    Range& range = touched_[static_cast<std::size_t>(v)];
    if (range.first < range.last) {
      std::fill(nearness_.begin() + static_cast<std::ptrdiff_t>(Index(range.first, v, 0)),
                nearness_.begin() + static_cast<std::ptrdiff_t>(Index(range.last, v, 0)), 0.0F);
    }
    range = {width_, 0};
  }
  top_ = height_;
  bottom_ = 0;
}

void DepthBuffer::Draw(const std::array<ImageCorner, 3>& corner,
                       const std::array<std::uint8_t, 3>& tone, unsigned samples) {
  std::array<ImageCorner, 3> p = corner;
  if (IsAbove(p[1], p[0])) std::swap(p[0], p[1]);
  if (IsAbove(p[2], p[1])) std::swap(p[1], p[2]);
  if (IsAbove(p[1], p[0])) std::swap(p[0], p[1]);
  const Vec2d &a = p[0].pixel, &b = p[1].pixel, &c = p[2].pixel;
  const double abx = b.x - a.x, aby = b.y - a.y, acx = c.x - a.x, acy = c.y - a.y;
  const double twice_area = abx * acy - aby * acx;
  if (!(std::abs(twice_area) > 0) || !std::isfinite(twice_area)) return;
  const auto plane = [&](double va, double vb, double vc) {
    const double ab = vb - va, ac = vc - va;
    return Plane{a, va, (ab * acy - ac * aby) / twice_area, (ac * abx - ab * acx) / twice_area};
  };
  const Plane nearness = plane(p[0].nearness, p[1].nearness, p[2].nearness);
  const Plane shade = plane(p[0].shade, p[1].shade, p[2].shade);
  const bool is_flat = p[0].shade == p[1].shade && p[0].shade == p[2].shade;
  const std::uint32_t flat = Shaded(tone, static_cast<float>(p[0].shade));
  const Side ab(p[0], p[1]), bc(p[1], p[2]), ac(p[0], p[2]);
  const bool b_is_right = twice_area > 0;

  const auto slope = static_cast<float>(nearness.dx), shade_slope = static_cast<float>(shade.dx);

  const int first_u = CeilWithin(std::min({a.x, b.x, c.x}) - 0.5, width_);
  const int last_u = CeilWithin(std::max({a.x, b.x, c.x}) + 0.5, width_);
  // Sample line k is at y = k / 4 - 3 / 8.
  const int first = CeilWithin((a.y + 0.375) * kSamples, kSamples * height_);
  const int last = CeilWithin((c.y + 0.375) * kSamples, kSamples * height_);
  if (first >= last || first_u >= last_u) return;
  const int first_v = first / kSamples, last_v = (last - 1) / kSamples;
  for (int v = first_v; v <= last_v; ++v) {
    Range& range = touched_[static_cast<std::size_t>(v)];
    range.first = std::min(range.first, first_u);
    range.last = std::max(range.last, last_u);
  }
  top_ = std::min(top_, first_v);
  bottom_ = std::max(bottom_, last_v + 1);
  // One sample alone is on every fourth line.
  const bool is_single = std::has_single_bit(samples);
  const int only = is_single ? std::countr_zero(samples) : 0;
  const int start_k = is_single ? first + (only - first % kSamples + kSamples) % kSamples : first;
  for (int k = start_k; k < last; k += is_single ? kSamples : 1) {
    const int v = k / kSamples, s = k % kSamples;
    if ((samples >> s & 1U) == 0) continue;
    const Vec2d& place = kPlace[static_cast<std::size_t>(s)];
    const double y = v + place.y;
    const Side& of_two = y < b.y ? ab : bc;
    const double x_long = ac.At(y), x_short = of_two.At(y);
    const double left = b_is_right ? x_long : x_short, right = b_is_right ? x_short : x_long;
    const int begin = CeilWithin(left - place.x, width_);
    const int end = CeilWithin(right - place.x, width_);
    if (begin >= end) continue;
    float* depth = nearness_.data() + Index(begin, v, s);
    std::uint32_t* colour = tone_.data() + Index(begin, v, s);
    // The plane of a sliver is known badly, so no more is believed than the two sides allow.
    const double n_long = ac.NearnessAt(y), n_short = of_two.NearnessAt(y);
    const auto start = static_cast<float>(std::clamp(
        nearness.At(begin + place.x, y), std::min(n_long, n_short), std::max(n_long, n_short)));
    if (is_flat) {
      for (int way = 0; way < end - begin; ++way, depth += kSamples, colour += kSamples) {
        const float here = start + slope * static_cast<float>(way);
        if (!(here > *depth)) continue;
        *depth = here;
        *colour = flat;
      }
      continue;
    }
    const auto shade_start = static_cast<float>(shade.At(begin + place.x, y));
    for (int way = 0; way < end - begin; ++way, depth += kSamples, colour += kSamples) {
      const float here = start + slope * static_cast<float>(way);
      if (!(here > *depth)) continue;
      *depth = here;
      *colour = Shaded(tone, shade_start + shade_slope * static_cast<float>(way));
    }
  }
}

std::array<std::uint8_t, 3> DepthBuffer::Tone(int u, int v, int sample) const {
  const std::uint32_t packed = tone_[Index(u, v, sample)];
  return {static_cast<std::uint8_t>(packed), static_cast<std::uint8_t>(packed >> 8),
          static_cast<std::uint8_t>(packed >> 16)};
}

}  // namespace flocklift
