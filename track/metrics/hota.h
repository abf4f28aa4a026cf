// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Higher-order tracking accuracy (Luiten et al., "HOTA: a higher order metric for evaluating
// multi-object tracking", IJCV 2021). For each similarity threshold alpha = 0.05, 0.10 .. 0.95:
//   DetA = TP / (TP + FN + FP)
//   AssA = mean over true positives c of TPA(c) / (TPA(c) + FNA(c) + FPA(c))
//   HOTA = sqrt(DetA * AssA),   LocA = mean similarity of the true positives
// and then the mean over alpha. Frames are matched once, to maximise the sum of similarity times
// the global alignment of the two identities.

#ifndef FLOCKLIFT_TRACK_METRICS_HOTA_H_
#define FLOCKLIFT_TRACK_METRICS_HOTA_H_

#include "track/metrics/scored_frames.h"

namespace flocklift {

struct HotaScores {
  double hota = 0, det_a = 0, ass_a = 0, loc_a = 0;
  double hota_at_half = 0;   // HOTA at alpha = 0.5
  double det_recall = 0;     // TP / truth rows, mean over alpha
  double det_precision = 0;  // TP / result rows, mean over alpha
};

HotaScores ComputeHota(const ScoredFrames& compared);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_METRICS_HOTA_H_
