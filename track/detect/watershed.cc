// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/watershed.h"

#include <algorithm>

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

}  // namespace

std::vector<int> CutAtSaddles(const std::vector<float>& contrast, int width, int height,
                              const WatershedOptions& options, int* parts) {
  std::vector<int> order;
  for (int k = 0; k < width * height; ++k) {
    if (contrast[k] > 0) order.push_back(k);
  }
  std::sort(order.begin(), order.end(), [&contrast](int a, int b) {
    return contrast[a] != contrast[b] ? contrast[a] > contrast[b] : a < b;
  });

  std::vector<int> label(contrast.size(), -1);
  std::vector<Basin> basins;
  for (const int pixel : order) {
    const int u = pixel % width, v = pixel / width;
    const float value = contrast[pixel];
    int roots[8];
    int count = 0;
    int steepest = -1;
    float steepest_value = 0;
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const int x = u + du, y = v + dv;
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        const int neighbor = y * width + x;
        if (label[neighbor] < 0) continue;
        const int root = Root(&basins, label[neighbor]);
        if (contrast[neighbor] > steepest_value) {
          steepest_value = contrast[neighbor];
          steepest = root;
        }
        if (std::find(roots, roots + count, root) == roots + count) roots[count++] = root;
      }
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
  for (const int pixel : order) {
    const int root = Root(&basins, label[pixel]);
    if (number[root] < 0) number[root] = (*parts)++;
    label[pixel] = number[root];
  }
  return label;
}

}  // namespace flocklift
