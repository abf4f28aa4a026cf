// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the marks of an axis go: at multiples of 1, 2 or 5 times a power of ten.

#ifndef FLOCKLIFT_TOOLS_PLOT_TICKS_H_
#define FLOCKLIFT_TOOLS_PLOT_TICKS_H_

#include <string>
#include <vector>

namespace flocklift {

struct Ticks {
  double step = 1;
  std::vector<double> at;           // increasing, inside the range
  std::vector<std::string> labels;  // all with the same number of decimals
};

// At most about `wanted` marks in [low, high] (low < high, both finite).
Ticks NiceTicks(double low, double high, int wanted);

// A range of an axis that ends at multiples of a nice step and holds [low, high]; one value gets a
// range around it.
struct AxisRange {
  double low = 0, high = 1;
};
AxisRange NiceRange(double low, double high, int wanted);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PLOT_TICKS_H_
