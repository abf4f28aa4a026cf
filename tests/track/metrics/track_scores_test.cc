// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/metrics/track_scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr double kTight = 1e-12;

// Animal `id` flies along v = 100 * row over frames first .. last.
Tracklet Line(Id id, double row, int first, int last, double offset_px = 0) {
  Tracklet tracklet{id, {}};
  for (int frame = first; frame <= last; ++frame) {
    tracklet.detections.push_back(
        {frame, Box::Around({10.0 * frame + offset_px, 100 * row}, 8, 6), 1, {}});
  }
  return tracklet;
}

Tracks Of(std::vector<Tracklet> tracklets) {
  return {.fps = {}, .tracklets = std::move(tracklets)};
}

TrackScores Score(const Tracks& truth, const Tracks& result, TrackScoreOptions options = {}) {
  return ScoreTracks(options, truth, result);
}

TEST(TrackScores, PerfectResult) {
  const Tracks truth = Of({Line(1, 0, 1, 10), Line(2, 1, 3, 10)});
  const Tracks renamed = Of({Line(7, 1, 3, 10), Line(9, 0, 1, 10)});
  const TrackScores s = Score(truth, renamed);
  for (const double one : {s.hota.hota, s.hota.det_a, s.hota.ass_a, s.hota.loc_a, s.clear.mota,
                           s.clear.motp, s.clear.recall, s.identity.idf1}) {
    EXPECT_NEAR(one, 1, kTight);
  }
  EXPECT_EQ(s.clear.mostly_tracked, 2);
  EXPECT_EQ(s.clear.id_switches + s.clear.fragmentations, 0);
  EXPECT_EQ(s.truth_rows, 18);
  EXPECT_EQ(s.frames, 10);
}

TEST(TrackScores, LocalisationLowersHotaByTheThresholdsThatFail) {
  // 2.2 px off with d0 = 10: similarity 0.78, so alpha = 0.05 .. 0.75 (15 of 19) pass.
  const TrackScores s = Score(Of({Line(1, 0, 1, 10)}), Of({Line(1, 0, 1, 10, 2.2)}));
  EXPECT_NEAR(s.hota.hota, 15.0 / 19, kTight);
  EXPECT_NEAR(s.hota.loc_a, (15 * 0.78 + 4) / 19, 1e-9);  // nothing matched counts as 1
  EXPECT_NEAR(s.clear.motp, 0.78, 1e-9);
  EXPECT_NEAR(s.clear.mota, 1, kTight);
}

TEST(TrackScores, OneMissedFrame) {
  Tracks result = Of({Line(1, 0, 1, 10)});
  result.tracklets[0].detections.erase(result.tracklets[0].detections.begin() + 4);
  const TrackScores s = Score(Of({Line(1, 0, 1, 10)}), result);
  EXPECT_EQ(s.clear.false_negatives, 1);
  EXPECT_EQ(s.clear.id_switches, 0);
  // The result has nothing at all in that frame, so the link to the frame before is not broken.
  EXPECT_EQ(s.clear.fragmentations, 0);
  EXPECT_NEAR(s.clear.mota, 0.9, kTight);
  EXPECT_NEAR(s.hota.det_a, 0.9, kTight);
  EXPECT_NEAR(s.hota.ass_a, 0.9, kTight);  // 9 / (9 + 1 + 0)
  EXPECT_NEAR(s.identity.idf1, 18.0 / 19, kTight);
}

TEST(TrackScores, AMissAmongOthersIsAFragmentation) {
  Tracks result = Of({Line(1, 0, 1, 10), Line(2, 1, 1, 10)});
  result.tracklets[0].detections.erase(result.tracklets[0].detections.begin() + 4);
  const TrackScores s = Score(Of({Line(1, 0, 1, 10), Line(2, 1, 1, 10)}), result);
  EXPECT_EQ(s.clear.fragmentations, 1);
}

TEST(TrackScores, OneFalsePositive) {
  const TrackScores s = Score(Of({Line(1, 0, 1, 10)}), Of({Line(1, 0, 1, 10), Line(2, 5, 4, 4)}));
  EXPECT_EQ(s.clear.false_positives, 1);
  EXPECT_NEAR(s.clear.mota, 0.9, kTight);
  EXPECT_NEAR(s.hota.det_a, 10.0 / 11, kTight);
  EXPECT_NEAR(s.hota.ass_a, 1, kTight);
  EXPECT_NEAR(s.identity.idf1, 20.0 / 21, kTight);
  EXPECT_NEAR(s.mean_count_error, 0.1, kTight);
}

TEST(TrackScores, TwoAnimalsSwapHalfWay) {
  // Ids 1 and 2 trade animals after frame 5 of 10.
  Tracks result = Of({Line(1, 0, 1, 5), Line(2, 1, 1, 5)});
  const Tracklet tail1 = Line(1, 1, 6, 10), tail2 = Line(2, 0, 6, 10);
  auto& first = result.tracklets[0].detections;
  auto& second = result.tracklets[1].detections;
  first.insert(first.end(), tail1.detections.begin(), tail1.detections.end());
  second.insert(second.end(), tail2.detections.begin(), tail2.detections.end());
  const TrackScores s = Score(Of({Line(1, 0, 1, 10), Line(2, 1, 1, 10)}), result);
  EXPECT_EQ(s.clear.id_switches, 2);
  EXPECT_NEAR(s.clear.mota, 0.9, kTight);
  EXPECT_NEAR(s.hota.det_a, 1, kTight);
  EXPECT_NEAR(s.hota.ass_a, 1.0 / 3, kTight);  // TPA 5, FNA 5, FPA 5 for every pair
  EXPECT_NEAR(s.hota.hota, std::sqrt(1.0 / 3), kTight);
  EXPECT_NEAR(s.identity.idf1, 0.5, kTight);
}

TEST(TrackScores, TrackedPartlyAndLost) {
  const TrackScores s = Score(Of({Line(1, 0, 1, 10), Line(2, 1, 1, 10), Line(3, 2, 1, 10)}),
                              Of({Line(1, 0, 1, 9), Line(2, 1, 1, 8), Line(3, 2, 1, 1)}));
  EXPECT_EQ(s.clear.mostly_tracked, 1);  // 90 %; 80 % is not above 80 %
  EXPECT_EQ(s.clear.partly_tracked, 1);
  EXPECT_EQ(s.clear.mostly_lost, 1);
}

TEST(TrackScores, OverlapSimilarity) {
  // Boxes 8 px wide shifted by 2: overlap 6 of 10 columns.
  const TrackScores s =
      Score(Of({Line(1, 0, 1, 10)}), Of({Line(1, 0, 1, 10, 2)}), {.intersection_over_union = true});
  EXPECT_NEAR(s.clear.motp, 0.6, 1e-9);
}

TEST(TrackScores, IgnoredTruthCountsForNothing) {
  Tracks truth = Of({Line(1, 0, 1, 10), Line(2, 1, 1, 10)});
  for (Detection& detection : truth.tracklets[1].detections) detection.confidence = 0;
  const TrackScores with = Score(truth, Of({Line(1, 0, 1, 10), Line(2, 1, 1, 10)}));
  const TrackScores without = Score(truth, Of({Line(1, 0, 1, 10)}));
  for (const TrackScores& s : {with, without}) {
    EXPECT_NEAR(s.hota.hota, 1, kTight);
    EXPECT_NEAR(s.clear.mota, 1, kTight);
    EXPECT_EQ(s.truth_ids, 1);
    EXPECT_EQ(s.result_rows, 10);
  }
}

TEST(TrackScores, NothingAtAll) {
  const TrackScores s = Score({}, {});
  EXPECT_EQ(s.frames, 0);
  EXPECT_EQ(s.hota.hota, 0);
  const TrackScores missing = Score(Of({Line(1, 0, 1, 10)}), {});
  EXPECT_EQ(missing.clear.false_negatives, 10);
  EXPECT_EQ(missing.clear.mostly_lost, 1);
  EXPECT_EQ(missing.hota.hota, 0);
}

TEST(TrackScores, BadOptionsAreRefused) {
  EXPECT_THROW(Score({}, {}, {.distance_scale = 0}), std::invalid_argument);
  EXPECT_THROW(Score({}, {}, {.threshold = 1.5}), std::invalid_argument);
}

// A noisy result with misses, clutter and swaps, scored by formulas written down densely: every
// pair of rows is looked at, HOTA at alpha = 0.5 by its definition once the matching is known.
TEST(TrackScores, PairsAgreeWithTheDenseDefinition) {
  Tracks truth, result;
  for (Id id = 1; id <= 30; ++id) {
    Tracklet animal{id, {}}, seen{id, {}};
    for (int frame = 1; frame <= 20; ++frame) {
      Rng rng(3, id, frame);
      const Vec2d centre{rng.Uniform(0, 150), rng.Uniform(0, 100)};
      const double width = rng.Uniform(3, 20);
      animal.detections.push_back({frame, Box::Around(centre, width, 6), 1, {}});
      if (rng.Below(10) == 0) continue;
      seen.detections.push_back(
          {frame,
           Box::Around({centre.x + 3 * rng.Normal(), centre.y + 3 * rng.Normal()}, 9, 6),
           1,
           {}});
    }
    truth.tracklets.push_back(animal);
    result.tracklets.push_back(seen);
  }
  for (const bool overlap : {false, true}) {
    const ScoredFrames compared =
        CompareTracks({.intersection_over_union = overlap}, truth, result);
    for (int frame = 1; frame <= 20; ++frame) {
      std::map<std::pair<Id, Id>, double> sparse, dense;
      const auto& scored = compared.frames[frame - 1];
      for (const auto& pair : scored.pairs) {
        // Ids count from 1 and appear in order, all of them in the first frames.
        sparse[{scored.truth[pair.truth], scored.result[pair.result]}] = pair.similarity;
      }
      std::vector<std::pair<int, Box>> a, b;
      for (const auto* side : {&truth, &result}) {
        for (const Tracklet& tracklet : side->tracklets) {
          for (const Detection& d : tracklet.detections) {
            if (d.frame == frame) {
              (side == &truth ? a : b).push_back({static_cast<int>(tracklet.id), d.box});
            }
          }
        }
      }
      for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
          const Box &p = a[i].second, &q = b[j].second;
          double similarity =
              1 - std::hypot(p.Center().x - q.Center().x, p.Center().y - q.Center().y) / 10;
          if (overlap) {
            const double w =
                std::min(p.left + p.width, q.left + q.width) - std::max(p.left, q.left);
            const double h = std::min(p.top + p.height, q.top + q.height) - std::max(p.top, q.top);
            const double both = w > 0 && h > 0 ? w * h : 0;
            similarity = both / (p.width * p.height + q.width * q.height - both);
          }
          if (similarity > 0) dense[{scored.truth[i], scored.result[j]}] = similarity;
        }
      }
      ASSERT_EQ(sparse.size(), dense.size());
      for (const auto& [key, value] : dense) EXPECT_NEAR(sparse.at(key), value, 1e-12);
    }
  }
}

}  // namespace
}  // namespace flocklift
