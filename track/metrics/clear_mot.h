// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// CLEAR multi-object tracking figures (Bernardin, Stiefelhagen, "Evaluating multiple object
// tracking performance: the CLEAR MOT metrics", 2008):
//   MOTA = 1 - (FN + FP + IDSW) / truth rows
// Frames are matched one after the other at one similarity threshold; a pair that was matched in
// the frame before is kept where it still is one.

#ifndef FLOCKLIFT_TRACK_METRICS_CLEAR_MOT_H_
#define FLOCKLIFT_TRACK_METRICS_CLEAR_MOT_H_

#include <cstdint>

#include "track/metrics/scored_frames.h"

namespace flocklift {

struct ClearScores {
  double mota = 0;
  double motp = 0;  // mean similarity of the matches
  std::int64_t true_positives = 0, false_positives = 0, false_negatives = 0;
  std::int64_t id_switches = 0;     // an animal is matched by another id than the last time
  std::int64_t fragmentations = 0;  // times that an animal is found again after it was lost
  int mostly_tracked = 0;           // animals matched in more than 80 % of their rows
  int partly_tracked = 0;
  int mostly_lost = 0;  // in less than 20 %
  double recall = 0, precision = 0;
};

ClearScores ComputeClear(double threshold, const ScoredFrames& compared);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_METRICS_CLEAR_MOT_H_
