// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/metrics/track_scores.h"

#include <cmath>

namespace flocklift {

TrackScores ScoreTracks(const TrackScoreOptions& options, const Tracks& truth,
                        const Tracks& result) {
  const ScoredFrames compared = CompareTracks(options, truth, result);
  TrackScores scores;
  scores.hota = ComputeHota(compared);
  scores.clear = ComputeClear(options.threshold, compared);
  scores.identity = ComputeIdentity(options.threshold, compared);
  scores.truth_ids = compared.truth_ids;
  scores.result_ids = compared.result_ids;
  scores.truth_rows = compared.TruthRows();
  scores.result_rows = compared.ResultRows();
  scores.frames = static_cast<int>(compared.frames.size());
  double error_sum = 0;
  for (const ScoredFrame& frame : compared.frames) {
    error_sum += std::abs(static_cast<double>(frame.truth.size()) -
                          static_cast<double>(frame.result.size()));
  }
  if (scores.frames > 0) scores.mean_count_error = error_sum / scores.frames;
  return scores;
}

std::vector<std::pair<std::string, double>> Figures(const TrackScores& s) {
  const auto number = [](std::int64_t count) { return static_cast<double>(count); };
  return {{"HOTA", s.hota.hota},
          {"DetA", s.hota.det_a},
          {"AssA", s.hota.ass_a},
          {"LocA", s.hota.loc_a},
          {"HOTA05", s.hota.hota_at_half},
          {"DetRe", s.hota.det_recall},
          {"DetPr", s.hota.det_precision},
          {"MOTA", s.clear.mota},
          {"MOTP", s.clear.motp},
          {"TP", number(s.clear.true_positives)},
          {"FP", number(s.clear.false_positives)},
          {"FN", number(s.clear.false_negatives)},
          {"IDSW", number(s.clear.id_switches)},
          {"Frag", number(s.clear.fragmentations)},
          {"MT", number(s.clear.mostly_tracked)},
          {"PT", number(s.clear.partly_tracked)},
          {"ML", number(s.clear.mostly_lost)},
          {"Recall", s.clear.recall},
          {"Precision", s.clear.precision},
          {"IDF1", s.identity.idf1},
          {"IDP", s.identity.id_precision},
          {"IDR", s.identity.id_recall},
          {"IDTP", number(s.identity.id_true_positives)},
          {"gt_ids", number(s.truth_ids)},
          {"result_ids", number(s.result_ids)},
          {"gt_dets", number(s.truth_rows)},
          {"result_dets", number(s.result_rows)},
          {"frames", number(s.frames)},
          {"mean_count_error", s.mean_count_error}};
}

}  // namespace flocklift
