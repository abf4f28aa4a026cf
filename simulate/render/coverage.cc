// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flocklift {
namespace {

constexpr int kStrips = 4;  // of a row

// First pixel less than 1 from [low, high] and the number of them, inside [0, size).
void PixelsThatSee(double low, double high, int size, int* first, int* count) {
  const double begin = std::clamp(std::floor(low), 0.0, double(size));
  const double end = std::clamp(std::ceil(high) + 1, 0.0, double(size));
  *first = static_cast<int>(begin);
  *count = std::max(0, static_cast<int>(end) - *first);
}

// B in the middle of the strips that row 0 sees, from 1 above it to 1 below, and its slope there:
// B is straight in each strip.
struct StripWeights {
  std::array<float, 2 * kStrips> value{}, slope{};

  constexpr StripWeights() {
    for (std::size_t k = 0; k < 2 * kStrips; ++k) {
      const float t = (static_cast<float>(k) + 0.5F) / kStrips - 1;
      value[k] = 1 - (t < 0 ? -t : t);
      slope[k] = t < 0 ? 1.0F : -1.0F;
    }
  }
};

}  // namespace

CoverageMask::CoverageMask(const Box& bounds, int image_width, int image_height) {
  PixelsThatSee(bounds.left, bounds.left + bounds.width, image_width, &left_, &width_);
  PixelsThatSee(bounds.top, bounds.top + bounds.height, image_height, &top_, &height_);
  if (empty()) {
    width_ = height_ = 0;
    return;
  }
  // Strip k reaches from top - 1 + k / kStrips one strip further down.
  amounts_.assign(Offset(kStrips * (height_ + 1)), 0.0F);
  moments_.assign(amounts_.size(), 0.0F);
}

void CoverageMask::Add(const Silhouette& silhouette, double weight) {
  const int strips = empty() ? 0 : kStrips * (height_ + 1);
  for (const Trapezoid& t : silhouette.trapezoids) {
    const double top = (t.top - top_ + 1) * kStrips, bottom = (t.bottom - top_ + 1) * kStrips;
    const double left_slope = (t.left_at_bottom - t.left_at_top) / (bottom - top);
    const double right_slope = (t.right_at_bottom - t.right_at_top) / (bottom - top);
    const double left = t.left_at_top - left_, right = t.right_at_top - left_;
    const int first = static_cast<int>(std::clamp(std::floor(top), 0.0, double(strips)));
    const int last = static_cast<int>(std::clamp(std::ceil(bottom), 0.0, double(strips)));
    for (int k = first; k < last; ++k) {
      const double y0 = std::max(top, double(k)), y1 = std::min(bottom, k + 1.0);
      if (!(y1 > y0)) continue;
      const double left0 = left + left_slope * (y0 - top), left1 = left + left_slope * (y1 - top);
      const double right0 = right + right_slope * (y0 - top);
      const double right1 = right + right_slope * (y1 - top);
      const auto add = [&](double amount, std::vector<float>* strip_values) {
        float* row = strip_values->data() + Offset(k);
        AddEdge(left0, left1, amount, row);
        AddEdge(right0, right1, -amount, row);
      };
      const double height = weight * (y1 - y0) / kStrips;
      const double off_middle = 0.5 * (y0 + y1) - (k + 0.5);
      add(height, &amounts_);
      if (std::abs(off_middle) > 1e-9) add(height * off_middle / kStrips, &moments_);
    }
  }
}

// Covers what lies to the right of a piece of edge that runs from x0 to x1 over a part `height` of
// the strip. With G(x) the height of the piece left of x and J'' = G, pixel k sees
//   integral of B(x - k) G(x) dx = J(k + 1) - 2 J(k) + J(k - 1).
void CoverageMask::AddEdge(double x0, double x1, double height, float* row) const {
  if (x0 > x1) std::swap(x0, x1);
  if (x1 <= -1) {
    row[0] += static_cast<float>(height);
    return;
  }
  if (x0 >= width_) return;
  const double length = x1 - x0, middle = 0.5 * (x0 + x1);
  const auto j = [&](double x) {
    if (x <= x0) return 0.0;
    if (x < x1) return height * (x - x0) * (x - x0) * (x - x0) / (6 * length);
    return height * (0.5 * (x - middle) * (x - middle) + length * length / 24);
  };
  const int first = std::max(0, static_cast<int>(std::floor(x0)));
  const int last = std::min(width_ - 1, static_cast<int>(std::min(x1, double(width_))) + 2);
  double before = j(first - 1), here = j(first), cover_before = 0;
  for (int k = first; k <= last; ++k) {
    const double after = j(k + 1);
    const double cover = after - 2 * here + before;
    row[k] += static_cast<float>(cover - cover_before);
    before = here;
    here = after;
    cover_before = cover;
  }
}

void CoverageMask::Finish() {
  constexpr StripWeights kWeights;
  rows_.assign(Offset(height_), 0.0F);
  for (int k = 0; k < (empty() ? 0 : kStrips * (height_ + 1)); ++k) {
    float* amount = amounts_.data() + Offset(k);
    float* moment = moments_.data() + Offset(k);
    for (int u = 1; u < width_; ++u) {
      amount[u] += amount[u - 1];
      moment[u] += moment[u - 1];
    }
    // The rows v with 0 <= k - kStrips v < 2 kStrips see this strip.
    for (int v = std::max(0, k / kStrips - 1); v <= std::min(height_ - 1, k / kStrips); ++v) {
      const auto place = static_cast<std::size_t>(k - kStrips * v);
      const float value = kWeights.value[place], slope = kWeights.slope[place];
      float* row = rows_.data() + Offset(v);
      for (int u = 0; u < width_; ++u) row[u] += value * amount[u] + slope * moment[u];
    }
  }
  for (float& share : rows_) share = std::clamp(share, 0.0F, 1.0F);
}

}  // namespace flocklift
