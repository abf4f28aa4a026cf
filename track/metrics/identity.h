// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Identity figures (Ristani et al., "Performance measures and a data set for multi-target,
// multi-camera tracking", 2016): one assignment of result ids to animals for the whole sequence
// that maximises the rows they share (IDTP);  IDF1 = 2 IDTP / (truth rows + result rows).

#ifndef FLOCKLIFT_TRACK_METRICS_IDENTITY_H_
#define FLOCKLIFT_TRACK_METRICS_IDENTITY_H_

#include <cstdint>

#include "track/metrics/scored_frames.h"

namespace flocklift {

struct IdentityScores {
  double idf1 = 0, id_precision = 0, id_recall = 0;
  std::int64_t id_true_positives = 0;
};

IdentityScores ComputeIdentity(double threshold, const ScoredFrames& compared);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_METRICS_IDENTITY_H_
