// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Maximum-weight matching of a sparse bipartite graph: each row and each column is used at most
// once, the sum of the chosen weights is as large as possible, nobody has to be matched. Exact, by
// shortest augmenting paths over reduced costs (Jonker, Volgenant, "A shortest augmenting path
// algorithm for dense and sparse linear assignment problems", Computing 38, 1987), with a private
// column of weight 0 for every row that stays single.

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
// chosen; of several pairs with the same row and column the heaviest counts. Time O(rows * edges
// reached * log), memory O(pairs).
std::vector<int> MaximumWeightMatching(std::span<const WeightedPair> pairs);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_METRICS_MATCHING_H_
