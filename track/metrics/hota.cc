// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/metrics/hota.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "track/metrics/matching.h"

namespace flocklift {
namespace {

constexpr int kAlphas = 19;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double Alpha(int n) { return 0.05 + 0.05 * n; }

using IdentityPair = std::int64_t;  // truth id * result ids + result id

struct Alignments {
  std::vector<double> truth_rows, result_rows;         // rows of each identity
  std::unordered_map<IdentityPair, double> alignment;  // Jaccard index of two identities, soft
};

// The soft count of common rows: a pair's share of all similarity that its two rows have.
Alignments AlignIdentities(const ScoredFrames& compared) {
  Alignments a;
  a.truth_rows.assign(compared.truth_ids, 0);
  a.result_rows.assign(compared.result_ids, 0);
  for (const ScoredFrame& frame : compared.frames) {
    for (const int id : frame.truth) ++a.truth_rows[id];
    for (const int id : frame.result) ++a.result_rows[id];
    std::vector<double> of_truth(frame.truth.size(), 0), of_result(frame.result.size(), 0);
    for (const SimilarPair& pair : frame.pairs) {
      of_truth[pair.truth] += pair.similarity;
      of_result[pair.result] += pair.similarity;
    }
    for (const SimilarPair& pair : frame.pairs) {
      const double all = of_truth[pair.truth] + of_result[pair.result] - pair.similarity;
      const IdentityPair key =
          IdentityPair{frame.truth[pair.truth]} * compared.result_ids + frame.result[pair.result];
      a.alignment[key] += pair.similarity / std::max(all, kEpsilon);
    }
  }
  for (auto& [key, common] : a.alignment) {
    common /=
        a.truth_rows[key / compared.result_ids] + a.result_rows[key % compared.result_ids] - common;
  }
  return a;
}

}  // namespace

HotaScores ComputeHota(const ScoredFrames& compared) {
  const Alignments identities = AlignIdentities(compared);
  std::array<double, kAlphas> true_positives{}, similarity_sum{};
  std::unordered_map<IdentityPair, std::array<int, kAlphas>> common;  // TPA by pair and alpha
  std::vector<WeightedPair> weighted;
  for (const ScoredFrame& frame : compared.frames) {
    const auto key_of = [&](const SimilarPair& pair) {
      return IdentityPair{frame.truth[pair.truth]} * compared.result_ids +
             frame.result[pair.result];
    };
    weighted.clear();
    for (const SimilarPair& pair : frame.pairs) {
      weighted.push_back(
          {pair.truth, pair.result, identities.alignment.at(key_of(pair)) * pair.similarity});
    }
    for (const int k : MaximumWeightMatching(weighted)) {
      const SimilarPair& pair = frame.pairs[k];
      auto& counts = common[key_of(pair)];
      for (int n = 0; n < kAlphas && pair.similarity >= Alpha(n) - kEpsilon; ++n) {
        ++true_positives[n];
        similarity_sum[n] += pair.similarity;
        ++counts[n];
      }
    }
  }

  // Integers squared over integers: summed by increasing key, so that the sum is reproducible.
  std::vector<IdentityPair> keys;
  for (const auto& entry : common) keys.push_back(entry.first);
  std::sort(keys.begin(), keys.end());
  std::array<double, kAlphas> association{};
  for (const IdentityPair key : keys) {
    const double either = identities.truth_rows[key / compared.result_ids] +
                          identities.result_rows[key % compared.result_ids];
    const auto& counts = common.at(key);
    for (int n = 0; n < kAlphas; ++n) {
      const double c = counts[n];
      association[n] += c * c / std::max(1.0, either - c);
    }
  }

  const double truth_rows = static_cast<double>(compared.TruthRows());
  const double result_rows = static_cast<double>(compared.ResultRows());
  HotaScores scores;
  for (int n = 0; n < kAlphas; ++n) {
    const double tp = true_positives[n];
    const double det_a = tp / std::max(1.0, truth_rows + result_rows - tp);
    const double ass_a = tp > 0 ? association[n] / tp : 0;
    const double hota = std::sqrt(det_a * ass_a);
    scores.det_a += det_a / kAlphas;
    scores.ass_a += ass_a / kAlphas;
    scores.hota += hota / kAlphas;
    scores.loc_a += (tp > 0 ? similarity_sum[n] / tp : 1) / kAlphas;  // nothing matched: 1
    scores.det_recall += tp / std::max(1.0, truth_rows) / kAlphas;
    scores.det_precision += tp / std::max(1.0, result_rows) / kAlphas;
    if (n == 9) scores.hota_at_half = hota;
  }
  return scores;
}

}  // namespace flocklift
