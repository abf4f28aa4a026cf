// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/histogram.h"

#include <algorithm>

#include "simulate/core/check.h"

namespace flocklift {

Histogram MakeHistogram(std::span<const double> values, double low, double high, int bins) {
  Check(low < high && bins >= 1, "a histogram needs a range and at least one bin");
  Histogram histogram{low, high, std::vector<double>(bins, 0)};
  if (values.empty()) return histogram;
  const double unit = 100.0 / static_cast<double>(values.size());
  for (const double value : values) {
    if (!(value >= low && value <= high)) continue;
    const int bin = static_cast<int>((value - low) / (high - low) * bins);
    histogram.share[std::min(bin, bins - 1)] += unit;
  }
  return histogram;
}

}  // namespace flocklift
