// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Medians, quantiles and rank correlation: the figures that a few wild values do not move.

#ifndef FLOCKLIFT_RECONSTRUCT_METRICS_ORDER_STATISTICS_H_
#define FLOCKLIFT_RECONSTRUCT_METRICS_ORDER_STATISTICS_H_

#include <optional>
#include <span>
#include <vector>

namespace flocklift {

// The value below which the share `q` in [0, 1] of the values lies, linear between neighbours
// (Hyndman and Fan's definition 7, as in NumPy and R). Nothing when there are no values.
std::optional<double> Quantile(std::vector<double> values, double q);
std::optional<double> Median(std::vector<double> values);

// Several quantiles of values that are sorted already and not empty.
double QuantileOfSorted(std::span<const double> sorted, double q);

// Spearman's rho: the correlation of the ranks, equal values sharing their mean rank. Nothing for
// fewer than 2 pairs or when one side is constant.
std::optional<double> SpearmanCorrelation(std::span<const double> a, std::span<const double> b);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_METRICS_ORDER_STATISTICS_H_
