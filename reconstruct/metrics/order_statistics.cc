// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/metrics/order_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

std::vector<double> Ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    const double mean_rank = 0.5 * static_cast<double>(first + end - 1);
    for (; first < end; ++first) ranks[order[first]] = mean_rank;
  }
  return ranks;
}

}  // namespace

double QuantileOfSorted(std::span<const double> sorted, double q) {
  Check(!sorted.empty(), "a quantile of no values does not exist");
  Check(q >= 0 && q <= 1, "a quantile is of a share between 0 and 1");
  const double position = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::optional<double> Quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  return QuantileOfSorted(values, q);
}

std::optional<double> Median(std::vector<double> values) {
  return Quantile(std::move(values), 0.5);
}

std::optional<double> SpearmanCorrelation(std::span<const double> a, std::span<const double> b) {
  Check(a.size() == b.size(), "a correlation needs pairs of values");
  if (a.size() < 2) return std::nullopt;
  const std::vector<double> rank_a = Ranks(a), rank_b = Ranks(b);
  const double mean = 0.5 * static_cast<double>(a.size() - 1);
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    aa += (rank_a[k] - mean) * (rank_a[k] - mean);
    bb += (rank_b[k] - mean) * (rank_b[k] - mean);
    ab += (rank_a[k] - mean) * (rank_b[k] - mean);
  }
  if (!(aa > 0) || !(bb > 0)) return std::nullopt;
  return ab / std::sqrt(aa * bb);
}

}  // namespace flocklift
