// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/metrics/clear_mot.h"

#include <algorithm>
#include <limits>

#include "track/metrics/matching.h"

namespace flocklift {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kContinuity = 1000;  // a pair of the frame before outweighs any similarity

struct Coverage {
  int rows = 0, matched = 0, segments = 0;
};

void CountCoverage(const std::vector<Coverage>& animals, ClearScores* scores) {
  for (const Coverage& animal : animals) {
    scores->fragmentations += std::max(0, animal.segments - 1);
    const double share = static_cast<double>(animal.matched) / animal.rows;
    if (share > 0.8) {
      ++scores->mostly_tracked;
    } else if (share < 0.2) {
      ++scores->mostly_lost;
    } else {
      ++scores->partly_tracked;
    }
  }
}

}  // namespace

ClearScores ComputeClear(double threshold, const ScoredFrames& compared) {
  ClearScores scores;
  std::vector<Coverage> animals(compared.truth_ids);
  std::vector<int> last(compared.truth_ids, -1);      // the id that an animal had when last matched
  std::vector<int> previous(compared.truth_ids, -1);  // in the last frame that had rows of both
  double similarity_sum = 0;
  std::vector<WeightedPair> weighted;
  std::vector<int> matched_now, matched_before;
  for (const ScoredFrame& frame : compared.frames) {
    for (const int id : frame.truth) ++animals[id].rows;
    const auto truth_rows = static_cast<std::int64_t>(frame.truth.size());
    const auto result_rows = static_cast<std::int64_t>(frame.result.size());
    std::int64_t matches = 0;
    if (truth_rows > 0 && result_rows > 0) {
      weighted.clear();
      std::vector<double> similarity;
      for (const SimilarPair& pair : frame.pairs) {
        if (pair.similarity < threshold - kEpsilon) continue;
        const bool kept = previous[frame.truth[pair.truth]] == frame.result[pair.result];
        weighted.push_back({pair.truth, pair.result, pair.similarity + (kept ? kContinuity : 0)});
        similarity.push_back(pair.similarity);
      }
      matched_now.clear();
      std::vector<int> id_now;
      for (const int k : MaximumWeightMatching(weighted)) {
        const int animal = frame.truth[weighted[k].row];
        const int id = frame.result[weighted[k].column];
        if (last[animal] >= 0 && last[animal] != id) ++scores.id_switches;
        ++animals[animal].matched;
        if (previous[animal] < 0) ++animals[animal].segments;
        last[animal] = id;
        matched_now.push_back(animal);
        id_now.push_back(id);
        similarity_sum += similarity[k];
        ++matches;
      }
      for (const int animal : matched_before) previous[animal] = -1;
      for (std::size_t k = 0; k < matched_now.size(); ++k) previous[matched_now[k]] = id_now[k];
      std::swap(matched_before, matched_now);
    }
    scores.true_positives += matches;
    scores.false_negatives += truth_rows - matches;
    scores.false_positives += result_rows - matches;
  }
  CountCoverage(animals, &scores);

  const double truth_rows =
      std::max(1.0, static_cast<double>(scores.true_positives + scores.false_negatives));
  const double result_rows =
      std::max(1.0, static_cast<double>(scores.true_positives + scores.false_positives));
  scores.mota =
      static_cast<double>(scores.true_positives - scores.false_positives - scores.id_switches) /
      truth_rows;
  scores.motp = similarity_sum / std::max(1.0, static_cast<double>(scores.true_positives));
  scores.recall = static_cast<double>(scores.true_positives) / truth_rows;
  scores.precision = static_cast<double>(scores.true_positives) / result_rows;
  return scores;
}

}  // namespace flocklift
