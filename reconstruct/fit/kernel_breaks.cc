// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_breaks.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr std::size_t kCells = 2000;
constexpr double kMostPairs = 3e6;  // that the shares are counted from

// Calls take(r) for the pairs of every stride-th frame.
template <typename Take>
void ForEachPair(const std::vector<ObservedFlock>& flocks, double reach, int stride,
                 const Take& take) {
  for (const ObservedFlock& flock : flocks) {
    for (int frame = flock.span().first; frame <= flock.span().last; frame += stride) {
      const std::vector<int>& alive = flock.Alive(frame);
      for (std::size_t i = 0; i < alive.size(); ++i) {
        for (std::size_t j = i + 1; j < alive.size(); ++j) {
          const double r = Norm(flock.Position(alive[i], frame) - flock.Position(alive[j], frame));
          if (reach <= 0 || r <= reach) take(r);
        }
      }
    }
  }
}

// Adds `part`, scaled to the sum `share`.
void AddPart(const std::vector<double>& part, double share, std::vector<double>* sum) {
  double total = 0;
  for (const double value : part) total += value;
  if (!(total > 0)) return;
  for (std::size_t k = 0; k < part.size(); ++k) (*sum)[k] += share * part[k] / total;
}

}  // namespace

double PairDensity::At(double distance, double half_width) const {
  const double first = std::clamp((distance - half_width - low) / Cell(), 0.0,
                                  static_cast<double>(share.size() - 1));
  const double last = std::clamp((distance + half_width - low) / Cell(), 0.0,
                                 static_cast<double>(share.size() - 1));
  double sum = 0;
  for (auto k = static_cast<std::size_t>(first); k <= static_cast<std::size_t>(last); ++k) {
    sum += share[k];
  }
  return sum / ((std::floor(last) - std::floor(first) + 1) * Cell());
}

PairDensity MeasurePairs(const std::vector<ObservedFlock>& flocks, double reach) {
  PairDensity density;
  density.low = HUGE_VAL;
  density.high = 0;
  double all = 0;
  ForEachPair(flocks, reach, 1, [&](double r) {
    density.low = std::min(density.low, r);
    density.high = std::max(density.high, r);
    ++all;
  });
  density.share.assign(kCells, 0.0);
  if (!(density.high > density.low)) return density;
  const int stride = static_cast<int>(std::ceil(all / kMostPairs));
  ForEachPair(flocks, reach, std::max(1, stride), [&](double r) {
    const auto cell = static_cast<std::size_t>((r - density.low) / density.Cell());
    density.share[std::min(cell, kCells - 1)] += 1;
    density.pairs += 1;
  });
  for (double& share : density.share) share /= density.pairs;
  return density;
}

std::vector<double> ChooseBreaks(const PairDensity& pairs, int intervals, double shortest,
                                 const std::function<double(double)>& bend) {
  Check(pairs.IsUsable() && intervals >= 1, "no distances to break up");
  const std::size_t cells = pairs.share.size();
  std::vector<double> even(cells, 1.0), leverage(cells), bent(cells), weight(cells, 0.0);
  for (std::size_t k = 0; k < cells; ++k) {
    leverage[k] = pairs.Middle(k) * pairs.share[k];
    if (bend) bent[k] = std::cbrt(bend(pairs.Middle(k)));
  }
  AddPart(even, bend ? 0.25 : 0.5, &weight);
  AddPart(leverage, bend ? 0.25 : 0.5, &weight);
  AddPart(bent, 0.5, &weight);
  double total = 0, kept = 0;
  for (const double value : weight) total += value;
  if (shortest > 0) {
    const double most = total * pairs.Cell() / (shortest * intervals);
    for (double& value : weight) value = std::min(value, most);
  }
  for (const double value : weight) kept += value;
  intervals = std::max(1, static_cast<int>(std::ceil(intervals * kept / total)));
  total = kept;
  std::vector<double> breaks = {pairs.low};
  double before = 0;
  for (std::size_t k = 0; k < cells; ++k) {
    const double after = before + weight[k] / total;
    while (static_cast<int>(breaks.size()) < intervals) {
      const double wanted = static_cast<double>(breaks.size()) / intervals;
      if (wanted > after) break;
      const double part = (wanted - before) / (after - before);
      breaks.push_back(pairs.low + (static_cast<double>(k) + part) * pairs.Cell());
    }
    before = after;
  }
  breaks.push_back(pairs.high);
  return breaks;
}

}  // namespace flocklift
