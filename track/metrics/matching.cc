// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/metrics/matching.h"

#include <algorithm>

#include "simulate/core/check.h"
#include "track/associate/assignment.h"

namespace flocklift {

std::vector<int> MaximumWeightMatching(std::span<const WeightedPair> pairs) {
  int rows = 0, columns = 0;
  std::vector<Candidate> candidates;
  candidates.reserve(pairs.size());
  for (const WeightedPair& pair : pairs) {
    Check(pair.row >= 0 && pair.column >= 0, "rows and columns of a matching count from 0");
    rows = std::max(rows, pair.row + 1);
    columns = std::max(columns, pair.column + 1);
    if (pair.weight > 0) candidates.push_back({pair.row, pair.column, -pair.weight});
  }
  const std::vector<double> alone(rows, 0.0);
  const std::vector<int> column_of = Assign(columns, candidates, alone);

  std::vector<int> pair_of(rows, -1);
  for (int k = 0; k < static_cast<int>(pairs.size()); ++k) {
    const WeightedPair& pair = pairs[k];
    if (!(pair.weight > 0) || column_of[pair.row] != pair.column) continue;
    int& best = pair_of[pair.row];
    if (best < 0 || pair.weight > pairs[best].weight) best = k;
  }
  std::erase(pair_of, -1);
  return pair_of;
}

}  // namespace flocklift
