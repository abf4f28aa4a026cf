// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/ticks.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"
#include "tools/plot/markup.h"

namespace flocklift {
namespace {

// The smallest of 1, 2, 5 times a power of ten that is at least `rough`.
double NiceStep(double rough) {
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

}  // namespace

Ticks NiceTicks(double low, double high, int wanted) {
  Check(std::isfinite(low) && std::isfinite(high) && low < high, "an axis needs a finite range");
  Check(wanted >= 1, "an axis needs at least one mark");
  Ticks ticks;
  ticks.step = NiceStep((high - low) / wanted);
  const int decimals =
      std::clamp(static_cast<int>(-std::floor(std::log10(ticks.step) + 1e-9)), 0, 12);
  const double slack = 1e-9 * ticks.step;
  const double first = std::ceil((low - slack) / ticks.step);
  for (double k = first; k * ticks.step <= high + slack; ++k) {
    const double value = k * ticks.step;
    ticks.at.push_back(value);
    ticks.labels.push_back(std::abs(value) < 1e7 ? FixedText(value, decimals)
                                                 : NumberText(value, 4));
  }
  return ticks;
}

AxisRange NiceRange(double low, double high, int wanted) {
  if (!(std::isfinite(low) && std::isfinite(high)) || low > high) return {};
  if (high - low <= 1e-9 * std::max(std::abs(low), std::abs(high))) {
    const double around = std::max(0.5, 0.1 * std::abs(low));
    low -= around;
    high += around;
  }
  const double step = NiceStep((high - low) / wanted);
  return {step * std::floor(low / step + 1e-9), step * std::ceil(high / step - 1e-9)};
}

}  // namespace flocklift
