// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/watershed.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace flocklift {
namespace {

// Sorts by decreasing contrast, then increasing index: positive floats sort as their bits.
std::uint64_t KeyOf(float contrast, std::size_t index) {
  return (std::uint64_t{~std::bit_cast<std::uint32_t>(contrast)} << 32) |
         static_cast<std::uint32_t>(index);
}

std::size_t IndexOf(std::uint64_t key) { return static_cast<std::uint32_t>(key); }

}  // namespace

void Watershed::SetPatch(const std::vector<float>& contrast, int width, int height) {
  width_ = width;
  height_ = height;
  stride_ = width + 2;
  contrast_.assign(static_cast<std::size_t>(stride_) * (height + 2), 0);
  peak_ = 0;
  lowest_ = std::numeric_limits<float>::infinity();
  for (int v = 0; v < height; ++v) {
    const float* from = contrast.data() + static_cast<std::size_t>(v) * width;
    float* to = contrast_.data() + static_cast<std::size_t>(v + 1) * stride_ + 1;
    for (int u = 0; u < width; ++u) {
      to[u] = from[u];
      if (from[u] <= 0) continue;
      peak_ = std::max(peak_, from[u]);
      lowest_ = std::min(lowest_, from[u]);
    }
  }
}

// Whether at most one pixel is a peak so high that it could stay apart from a higher one: then
// nothing is cut.
bool Watershed::IsWhole(const WatershedOptions& options) const {
  const double least =
      std::max(lowest_ + options.least_dip, lowest_ / std::max(1 - options.relative_dip, 1e-9));
  if (peak_ < least) return true;
  int peaks = 0;
  for (int v = 1; v <= height_; ++v) {
    const float* at = contrast_.data() + static_cast<std::size_t>(v) * stride_ + 1;
    for (const float* end = at + width_; at < end; ++at) {
      if (*at < least) continue;
      const float* above = at - stride_;
      const float* below = at + stride_;
      const float highest =
          std::max({at[-1], at[1], above[-1], above[0], above[1], below[-1], below[0], below[1]});
      if (*at >= highest && ++peaks > 1) return false;
    }
  }
  return true;
}

int Watershed::Root(int k) {
  while (basins_[k].parent != k) {
    basins_[k].parent = basins_[basins_[k].parent].parent;
    k = basins_[k].parent;
  }
  return k;
}

// Labels all pixels by the basins that they run down to, from the highest to the lowest.
void Watershed::Flood(const WatershedOptions& options) {
  keys_.clear();
  for (std::size_t k = 0; k < contrast_.size(); ++k) {
    if (contrast_[k] > 0) keys_.push_back(KeyOf(contrast_[k], k));
  }
  std::sort(keys_.begin(), keys_.end());
  const int around[] = {-stride_ - 1, -stride_, -stride_ + 1, -1, 1,
                        stride_ - 1,  stride_,  stride_ + 1};
  label_.assign(contrast_.size(), -1);
  basins_.clear();
  for (const std::uint64_t key : keys_) {
    const auto pixel = static_cast<int>(IndexOf(key));
    const float value = contrast_[pixel];
    int roots[8];
    int count = 0;
    int steepest = -1;
    float steepest_value = 0;
    for (const int step : around) {
      const int neighbor = pixel + step;
      if (label_[neighbor] < 0) continue;
      const int root = Root(label_[neighbor]);
      if (contrast_[neighbor] > steepest_value) {
        steepest_value = contrast_[neighbor];
        steepest = root;
      }
      if (std::find(roots, roots + count, root) == roots + count) roots[count++] = root;
    }
    if (count == 0) {
      label_[pixel] = static_cast<int>(basins_.size());
      basins_.push_back({value, value, label_[pixel]});
      continue;
    }
    label_[pixel] = steepest;
    basins_[steepest].mass += value;
    for (int a = 0; a < count; ++a) {
      for (int b = a + 1; b < count; ++b) {
        int high = Root(roots[a]), low = Root(roots[b]);
        if (high == low) continue;
        if (basins_[low].peak > basins_[high].peak) std::swap(high, low);
        const double dip = basins_[low].peak - value;
        const double lighter = std::min(basins_[low].mass, basins_[high].mass);
        const double heavier = std::max(basins_[low].mass, basins_[high].mass);
        if (dip >= options.relative_dip * basins_[low].peak && dip >= options.least_dip &&
            lighter >= options.least_share * heavier) {
          continue;
        }
        basins_[low].parent = high;
        basins_[high].mass += basins_[low].mass;
      }
    }
  }
}

int Watershed::Cut(const std::vector<float>& contrast, int width, int height,
                   const WatershedOptions& options) {
  SetPatch(contrast, width, height);
  if (IsWhole(options)) return peak_ > 0 ? 1 : 0;
  Flood(options);
  number_.assign(basins_.size(), -1);
  part_.assign(contrast.size(), -1);
  int parts = 0;
  for (const std::uint64_t key : keys_) {
    const auto k = static_cast<int>(IndexOf(key));
    const int root = Root(label_[k]);
    if (number_[root] < 0) number_[root] = parts++;
    part_[static_cast<std::size_t>(k / stride_ - 1) * width + k % stride_ - 1] = number_[root];
  }
  return parts;
}

}  // namespace flocklift
