// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/canvas.h"

#include <algorithm>
#include <cmath>

namespace flocklift {
namespace {

constexpr int kShift = 6;
static_assert(Canvas::kUnit == 1 << kShift);
constexpr int kShareBits = 15;  // shares are whole numbers of 2^-15
constexpr std::int32_t kHalf = 1 << (kShareBits - 1);
constexpr double kWhole = 1 << kShareBits;

void Mix(const std::array<std::int32_t, 3>& tone, std::int32_t share, std::int32_t rounding,
         std::int16_t* pixel) {
  for (std::size_t c = 0; c < 3; ++c) {
    pixel[c] = static_cast<std::int16_t>(pixel[c] +
                                         (((tone[c] - pixel[c]) * share + rounding) >> kShareBits));
  }
}

// Bits that look random.
std::uint32_t GrainOf(std::uint32_t k) {
  k = (k ^ (k >> 16)) * 0x7feb352dU;
  k = (k ^ (k >> 15)) * 0x846ca68bU;
  return k ^ (k >> 16);
}

}  // namespace

Canvas::Canvas(int width, int height) : width_(width), height_(height), open_(Offset(height)) {}

void Canvas::Place(const DepthBuffer* surfaces, double haze) {
  surfaces_ = surfaces != nullptr && !surfaces->empty() ? surfaces : nullptr;
  if (surfaces_ == nullptr) return;
  covered_.resize(open_.size());
  for (int v = 0; v < height_; ++v) {
    const DepthBuffer::Range range = surfaces_->Touched(v);
    for (int u = range.first; u < range.last; ++u) {
      const int count = surfaces_->Covered(u, v);
      if (count == 0) continue;
      std::array<int, 3> sum{};
      float nearness = 0;
      for (int s = 0; s < DepthBuffer::kSamples; ++s) {
        const float here = surfaces_->Nearness(u, v, s);
        if (!(here > 0)) continue;
        nearness += here;
        const auto tone = surfaces_->Tone(u, v, s);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += tone[c];
      }
      const auto contrast = static_cast<std::int32_t>(
          haze > 0 ? kWhole * std::exp(-static_cast<float>(count / (nearness * haze))) : kWhole);
      const std::size_t at = Offset(v) + 3 * static_cast<std::size_t>(u);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::int32_t ground = open_[at + c], tone = sum[c] * kUnit / count;
        covered_[at + c] = static_cast<std::int16_t>(
            ground + (((tone - ground) * contrast + kHalf) >> kShareBits));
      }
    }
  }
}

void Canvas::Blend(int u, int v, std::int32_t share, std::int32_t rounding, const Paint& paint,
                   float nearness) {
  const std::size_t at = Offset(v) + 3 * static_cast<std::size_t>(u);
  if (surfaces_ != nullptr) {
    const int covered = surfaces_->Covered(u, v);
    if (covered > 0) {
      const int behind = surfaces_->Behind(u, v, nearness);
      if (behind > 0) Mix(paint.tone, share * behind / covered, rounding, covered_.data() + at);
      if (covered == DepthBuffer::kSamples) return;
    }
  }
  Mix(paint.tone, share, rounding, open_.data() + at);
}

void Canvas::LayOver(const CoverageMask& mask, const Paint& paint) {
  const auto nearness = static_cast<float>(1 / paint.depth);
  for (int row = 0; row < mask.height(); ++row) {
    const float* cover = mask.Row(row);
    for (int u = 0; u < mask.width(); ++u) {
      if (cover[u] == 0) continue;
      const auto share = static_cast<std::int32_t>(std::lround(cover[u] * paint.opacity * kWhole));
      Blend(mask.left() + u, mask.top() + row, share, kHalf, paint, nearness);
    }
  }
}

void Canvas::Dab(const Vec2d& pixel, double area, const Paint& paint, std::uint32_t grain) {
  if (!(pixel.x > -1 && pixel.y > -1 && pixel.x < width_ && pixel.y < height_)) return;
  const int u0 = static_cast<int>(pixel.x + 1) - 1, v0 = static_cast<int>(pixel.y + 1) - 1;
  const double x = pixel.x - u0, y = pixel.y - v0;
  const auto nearness = static_cast<float>(1 / paint.depth);
  const double whole = std::min(1.0, area) * paint.opacity * kWhole;
  for (int dv = 0; dv < 2; ++dv) {
    for (int du = 0; du < 2; ++du) {
      const int u = u0 + du, v = v0 + dv;
      if (u < 0 || v < 0 || u >= width_ || v >= height_) continue;
      const double exact = whole * (du == 0 ? 1 - x : x) * (dv == 0 ? 1 - y : y);
      // Two roundings, of the share and of the colour: both go up as often as they should.
      const std::uint32_t noise = GrainOf(grain++);
      const auto share = static_cast<std::int32_t>(exact + (noise >> 16) / 65536.0);
      const auto rounding = static_cast<std::int32_t>(noise & 0x7fffU);
      if (share > 0) Blend(u, v, share, rounding, paint, nearness);
    }
  }
}

void Canvas::Develop(int v, const std::int16_t* noise, std::uint8_t* out) {
  std::int16_t* row = Row(v);
  if (surfaces_ != nullptr) {
    const DepthBuffer::Range range = surfaces_->Touched(v);
    for (int u = range.first; u < range.last; ++u) {
      const int count = surfaces_->Covered(u, v);
      if (count == 0) continue;
      const std::int16_t* covered = covered_.data() + Offset(v) + 3 * static_cast<std::size_t>(u);
      std::int16_t* pixel = row + 3 * static_cast<std::size_t>(u);
      for (int c = 0; c < 3; ++c) {
        pixel[c] = static_cast<std::int16_t>((count * covered[c] +
                                              (DepthBuffer::kSamples - count) * pixel[c] +
                                              DepthBuffer::kSamples / 2) /
                                             DepthBuffer::kSamples);
      }
    }
  }
  constexpr int kTop = 255 * kUnit;
  const int length = 3 * width_;
  if (noise == nullptr) {
    for (int k = 0; k < length; ++k) {
      out[k] = static_cast<std::uint8_t>((row[k] + kUnit / 2) >> kShift);
    }
    return;
  }
  for (int k = 0; k < length; ++k) {
    // |noise| <= 16000 and row <= 16320: the sum fits 16 bits.
    auto sum = static_cast<std::int16_t>(row[k] + noise[k]);
    sum = std::clamp<std::int16_t>(sum, 0, kTop);
    out[k] = static_cast<std::uint8_t>(static_cast<std::int16_t>(sum + kUnit / 2) >> kShift);
  }
}

}  // namespace flocklift
