// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// All figures of a tracking result against the truth.

#ifndef FLOCKLIFT_TRACK_METRICS_TRACK_SCORES_H_
#define FLOCKLIFT_TRACK_METRICS_TRACK_SCORES_H_

#include <string>
#include <utility>
#include <vector>

#include "simulate/core/observations.h"
#include "track/metrics/clear_mot.h"
#include "track/metrics/hota.h"
#include "track/metrics/identity.h"
#include "track/metrics/scored_frames.h"

namespace flocklift {

struct TrackScores {
  HotaScores hota;
  ClearScores clear;
  IdentityScores identity;
  int truth_ids = 0, result_ids = 0;
  std::int64_t truth_rows = 0, result_rows = 0;
  int frames = 0;
  double mean_count_error = 0;  // mean over frames of |truth rows - result rows|
};

TrackScores ScoreTracks(const TrackScoreOptions& options, const Tracks& truth,
                        const Tracks& result);

// The figures by their usual names (HOTA, DetA .. IDF1), in the order of a table.
std::vector<std::pair<std::string, double>> Figures(const TrackScores& scores);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_METRICS_TRACK_SCORES_H_
