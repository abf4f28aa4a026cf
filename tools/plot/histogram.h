// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Equal bins over a range, as shares of all values.

#ifndef FLOCKLIFT_TOOLS_PLOT_HISTOGRAM_H_
#define FLOCKLIFT_TOOLS_PLOT_HISTOGRAM_H_

#include <span>
#include <vector>

namespace flocklift {

struct Histogram {
  double low = 0, high = 1;   // ends of the first and last bin
  std::vector<double> share;  // of all values, each bin [%]; what lies outside is in none
};

// `values` finite, low < high, bins >= 1; the last bin includes its upper end.
Histogram MakeHistogram(std::span<const double> values, double low, double high, int bins);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PLOT_HISTOGRAM_H_
