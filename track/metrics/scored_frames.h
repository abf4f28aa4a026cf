// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Truth and result of a tracker side by side, frame by frame: who is there, and how similar each
// truth row is to each result row. All tracking figures are computed from this.
//
// Similarity s in (0, 1]: 1 - d / d0 with d the distance of the box centres, or the intersection
// over union of the boxes. Pairs of similarity 0 are not listed, so the memory is linear in rows.

#ifndef FLOCKLIFT_TRACK_METRICS_SCORED_FRAMES_H_
#define FLOCKLIFT_TRACK_METRICS_SCORED_FRAMES_H_

#include <cstdint>
#include <vector>

#include "simulate/core/observations.h"

namespace flocklift {

struct TrackScoreOptions {
  bool intersection_over_union = false;  // similarity by box overlap instead of centre distance
  double distance_scale = 10;            // d0: similarity is 0 at this distance [px]
  double threshold = 0.5;                // similarity from which MOTA and IDF1 count a match
};

template <typename Visitor>
void Describe(Visitor& visit, TrackScoreOptions& o) {
  visit("iou", o.intersection_over_union, {}, "",
        "similarity of tracks by box overlap instead of centre distance");
  visit("d0", o.distance_scale, {.low = 1e-6, .high = 1e6}, "px",
        "centre distance at which the similarity of tracks is 0");
  visit("threshold", o.threshold, {.low = 1e-6, .high = 1}, "",
        "similarity from which MOTA and IDF1 count a match");
}

// Similarity of row `truth` to row `result` of one frame.
struct SimilarPair {
  int truth = 0;
  int result = 0;
  double similarity = 0;
};

struct ScoredFrame {
  std::vector<int> truth;   // compact id (0 .. truth_ids - 1) of each truth row
  std::vector<int> result;  // likewise of each result row
  std::vector<SimilarPair> pairs;
};

struct ScoredFrames {
  int truth_ids = 0;
  int result_ids = 0;
  std::vector<ScoredFrame> frames;  // every frame from the first to the last row, empty ones too

  std::int64_t TruthRows() const;
  std::int64_t ResultRows() const;
};

// Truth rows of confidence 0 are "don't care" as in MOTChallenge: they are taken out, together with
// the result rows that match them at the threshold.
ScoredFrames CompareTracks(const TrackScoreOptions& options, const Tracks& truth,
                           const Tracks& result);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_METRICS_SCORED_FRAMES_H_
