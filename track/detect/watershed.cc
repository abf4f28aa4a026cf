// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/watershed.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace flocklift {
namespace {

// A part that grows from its peak downwards; one that was joined to another points to it.
struct Basin {
  float peak = 0;
  double mass = 0;
  int parent = 0;
};

int Root(std::vector<Basin>* basins, int k) {
  while ((*basins)[k].parent != k) {
    (*basins)[k].parent = (*basins)[(*basins)[k].parent].parent;
    k = (*basins)[k].parent;
  }
  return k;
}

// Sorts by decreasing contrast, then increasing index: positive floats sort as their bits.
std::uint64_t KeyOf(float contrast, std::size_t index) {
  return (std::uint64_t{~std::bit_cast<std::uint32_t>(contrast)} << 32) |
         static_cast<std::uint32_t>(index);
}

// The patch inside a border of zeros, so that every pixel has eight neighbours.
struct Patch {
  int stride = 0;
  std::vector<float> contrast;
  std::vector<std::uint64_t> keys;  // of the pixels that are not 0
  float peak = 0, lowest = 0;       // of these
};

Patch Bordered(const std::vector<float>& contrast, int width, int height) {
  Patch patch;
  patch.stride = width + 2;
  patch.contrast.assign(static_cast<std::size_t>(patch.stride) * (height + 2), 0);
  patch.keys.reserve(contrast.size());
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const float value = contrast[static_cast<std::size_t>(v) * width + u];
      if (value <= 0) continue;
      const std::size_t k = static_cast<std::size_t>(v + 1) * patch.stride + u + 1;
      patch.contrast[k] = value;
      patch.lowest = patch.keys.empty() ? value : std::min(patch.lowest, value);
      patch.peak = std::max(patch.peak, value);
      patch.keys.push_back(KeyOf(value, k));
    }
  }
  return patch;
}

// Whether at most one pixel is a peak so high that it could stay apart from a higher one: then
// nothing is cut.
bool IsWhole(const Patch& patch, const WatershedOptions& options) {
  const double least = std::max(patch.lowest + options.least_dip,
                                patch.lowest / std::max(1 - options.relative_dip, 1e-9));
  if (patch.peak < least) return true;
  int peaks = 0;
  for (const std::uint64_t key : patch.keys) {
    const float* at = patch.contrast.data() + static_cast<std::uint32_t>(key);
    if (*at < least) continue;
    const float* above = at - patch.stride;
    const float* below = at + patch.stride;
    const float highest =
        std::max({at[-1], at[1], above[-1], above[0], above[1], below[-1], below[0], below[1]});
    if (*at >= highest && ++peaks > 1) return false;
  }
  return true;
}

}  // namespace

std::vector<int> CutAtSaddles(const std::vector<float>& contrast, int width, int height,
                              const WatershedOptions& options, int* parts) {
  Patch patch = Bordered(contrast, width, height);
  std::vector<int> part(contrast.size(), -1);
  const auto index_in_image = [&](std::uint64_t key) {
    const auto k = static_cast<int>(static_cast<std::uint32_t>(key));
    return (k / patch.stride - 1) * width + k % patch.stride - 1;
  };
  if (IsWhole(patch, options)) {
    *parts = patch.keys.empty() ? 0 : 1;
    for (const std::uint64_t key : patch.keys) part[index_in_image(key)] = 0;
    return part;
  }

  std::sort(patch.keys.begin(), patch.keys.end());
  const int around[] = {-patch.stride - 1, -patch.stride, -patch.stride + 1, -1, 1,
                        patch.stride - 1,  patch.stride,  patch.stride + 1};
  std::vector<int> label(patch.contrast.size(), -1);
  std::vector<Basin> basins;
  for (const std::uint64_t key : patch.keys) {
    const auto pixel = static_cast<int>(static_cast<std::uint32_t>(key));
    const float value = patch.contrast[pixel];
    int roots[8];
    int count = 0;
    int steepest = -1;
    float steepest_value = 0;
    for (const int step : around) {
      const int neighbor = pixel + step;
      if (label[neighbor] < 0) continue;
      const int root = Root(&basins, label[neighbor]);
      if (patch.contrast[neighbor] > steepest_value) {
        steepest_value = patch.contrast[neighbor];
        steepest = root;
      }
      if (std::find(roots, roots + count, root) == roots + count) roots[count++] = root;
    }
    if (count == 0) {
      label[pixel] = static_cast<int>(basins.size());
      basins.push_back({value, value, label[pixel]});
      continue;
    }
    label[pixel] = steepest;
    basins[steepest].mass += value;
    for (int a = 0; a < count; ++a) {
      for (int b = a + 1; b < count; ++b) {
        int high = Root(&basins, roots[a]), low = Root(&basins, roots[b]);
        if (high == low) continue;
        if (basins[low].peak > basins[high].peak) std::swap(high, low);
        const double dip = basins[low].peak - value;
        const double lighter = std::min(basins[low].mass, basins[high].mass);
        const double heavier = std::max(basins[low].mass, basins[high].mass);
        if (dip >= options.relative_dip * basins[low].peak && dip >= options.least_dip &&
            lighter >= options.least_share * heavier) {
          continue;
        }
        basins[low].parent = high;
        basins[high].mass += basins[low].mass;
      }
    }
  }

  std::vector<int> number(basins.size(), -1);
  *parts = 0;
  for (const std::uint64_t key : patch.keys) {
    const int root = Root(&basins, label[static_cast<std::uint32_t>(key)]);
    if (number[root] < 0) number[root] = (*parts)++;
    part[index_in_image(key)] = number[root];
  }
  return part;
}

}  // namespace flocklift
