// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Maximum-weight matching of a sparse bipartite graph: each row and each column is used at most
// once, the sum of the chosen weights is as large as possible, nobody has to be matched. Exact: the
// assignment of track/associate/assignment.h with costs -weight and a price of 0 for staying alone.

#ifndef FLOCKLIFT_TRACK_METRICS_MATCHING_H_
#define FLOCKLIFT_TRACK_METRICS_MATCHING_H_

#include <span>
#include <vector>

namespace flocklift {

struct WeightedPair {
  int row = 0;     // from 0
  int column = 0;  // from 0
  double weight = 0;
};

// Indices into `pairs` of the chosen ones, by increasing row. Pairs of weight <= 0 are never
// chosen; of several pairs with the same row and column the heaviest counts.
std::vector<int> MaximumWeightMatching(std::span<const WeightedPair> pairs);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_METRICS_MATCHING_H_
