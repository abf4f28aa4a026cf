// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/metrics/identity.h"

#include <algorithm>
#include <map>
#include <utility>

#include "track/metrics/matching.h"

namespace flocklift {

IdentityScores ComputeIdentity(double threshold, const ScoredFrames& compared) {
  std::map<std::pair<int, int>, std::int64_t> common;  // rows that an animal and an id share
  for (const ScoredFrame& frame : compared.frames) {
    for (const SimilarPair& pair : frame.pairs) {
      if (pair.similarity < threshold) continue;
      ++common[{frame.truth[pair.truth], frame.result[pair.result]}];
    }
  }
  std::vector<WeightedPair> weighted;
  for (const auto& [ids, rows] : common) {
    weighted.push_back({ids.first, ids.second, static_cast<double>(rows)});
  }
  IdentityScores scores;
  for (const int k : MaximumWeightMatching(weighted)) {
    scores.id_true_positives += static_cast<std::int64_t>(weighted[k].weight);
  }
  const double rows = static_cast<double>(scores.id_true_positives);
  const double truth_rows = static_cast<double>(compared.TruthRows());
  const double result_rows = static_cast<double>(compared.ResultRows());
  scores.idf1 = 2 * rows / std::max(1.0, truth_rows + result_rows);
  scores.id_precision = rows / std::max(1.0, result_rows);
  scores.id_recall = rows / std::max(1.0, truth_rows);
  return scores;
}

}  // namespace flocklift
