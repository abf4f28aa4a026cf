// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/metrics/scored_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "simulate/core/options.h"
#include "simulate/core/trajectory.h"
#include "track/metrics/matching.h"

namespace flocklift {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

struct Row {
  int frame = 0;
  Id id = 0;
  const Detection* detection = nullptr;
};

// All rows by frame, then id.
std::vector<Row> RowsByFrame(const Tracks& tracks) {
  std::vector<Row> rows;
  for (const Tracklet& tracklet : tracks.tracklets) {
    for (const Detection& detection : tracklet.detections) {
      rows.push_back({detection.frame, tracklet.id, &detection});
    }
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return a.frame != b.frame ? a.frame < b.frame : a.id < b.id;
  });
  return rows;
}

double CentreSimilarity(double distance_scale, const Box& a, const Box& b) {
  const Vec2d p = a.Center(), q = b.Center();
  return 1 - std::hypot(p.x - q.x, p.y - q.y) / distance_scale;
}

double OverlapSimilarity(const Box& a, const Box& b) {
  const double width = std::min(a.left + a.width, b.left + b.width) - std::max(a.left, b.left);
  const double height = std::min(a.top + a.height, b.top + b.height) - std::max(a.top, b.top);
  const double overlap = std::max(0.0, width) * std::max(0.0, height);
  const double together = a.width * a.height + b.width * b.height - overlap;
  return together > 0 ? overlap / together : 0;
}

// The pairs of positive similarity: rows of the result sorted by u, and for every truth row those
// that can reach it.
std::vector<SimilarPair> SimilarPairs(const TrackScoreOptions& options,
                                      const std::vector<Row>& truth,
                                      const std::vector<Row>& result) {
  double half_width = 0;
  for (const Row& row : result) half_width = std::max(half_width, 0.5 * row.detection->box.width);
  std::vector<int> by_u(result.size());
  std::iota(by_u.begin(), by_u.end(), 0);
  const auto u_of = [&](int k) { return result[k].detection->box.Center().x; };
  std::sort(by_u.begin(), by_u.end(), [&](int a, int b) { return u_of(a) < u_of(b); });

  std::vector<SimilarPair> pairs;
  for (int i = 0; i < static_cast<int>(truth.size()); ++i) {
    const Box& box = truth[i].detection->box;
    const double reach =
        options.intersection_over_union ? 0.5 * box.width + half_width : options.distance_scale;
    auto candidate = std::lower_bound(by_u.begin(), by_u.end(), box.Center().x - reach,
                                      [&](int k, double u) { return u_of(k) < u; });
    for (; candidate != by_u.end() && u_of(*candidate) <= box.Center().x + reach; ++candidate) {
      const Box& other = result[*candidate].detection->box;
      const double similarity = options.intersection_over_union
                                    ? OverlapSimilarity(box, other)
                                    : CentreSimilarity(options.distance_scale, box, other);
      if (similarity > 0) pairs.push_back({i, *candidate, similarity});
    }
  }
  return pairs;
}

// Takes out the truth rows that nobody cares about and the result rows that match them.
void RemoveIgnored(double threshold, std::vector<Row>* truth, std::vector<Row>* result,
                   std::vector<SimilarPair>* pairs) {
  const auto ignored = [](const Row& row) { return row.detection->confidence == 0; };
  if (std::none_of(truth->begin(), truth->end(), ignored)) return;
  std::vector<WeightedPair> candidates;
  for (const SimilarPair& pair : *pairs) {
    if (pair.similarity >= threshold - kEpsilon) {
      candidates.push_back({pair.truth, pair.result, pair.similarity});
    }
  }
  std::vector<int> new_truth(truth->size(), 0), new_result(result->size(), 0);
  for (const int k : MaximumWeightMatching(candidates)) {
    if (ignored((*truth)[candidates[k].row])) new_result[candidates[k].column] = -1;
  }
  for (std::size_t i = 0; i < truth->size(); ++i) {
    if (ignored((*truth)[i])) new_truth[i] = -1;
  }
  const auto compact = [](std::vector<Row>* rows, std::vector<int>* index) {
    std::vector<Row> kept;
    for (std::size_t k = 0; k < rows->size(); ++k) {
      if ((*index)[k] < 0) continue;
      (*index)[k] = static_cast<int>(kept.size());
      kept.push_back((*rows)[k]);
    }
    *rows = std::move(kept);
  };
  compact(truth, &new_truth);
  compact(result, &new_result);
  std::vector<SimilarPair> kept;
  for (const SimilarPair& pair : *pairs) {
    if (new_truth[pair.truth] < 0 || new_result[pair.result] < 0) continue;
    kept.push_back({new_truth[pair.truth], new_result[pair.result], pair.similarity});
  }
  *pairs = std::move(kept);
}

// Numbers ids from 0 in the order in which they appear.
class CompactIds {
 public:
  std::vector<int> Of(const std::vector<Row>& rows) {
    std::vector<int> compact;
    compact.reserve(rows.size());
    for (const Row& row : rows) {
      compact.push_back(numbers_.emplace(row.id, static_cast<int>(numbers_.size())).first->second);
    }
    return compact;
  }
  int count() const { return static_cast<int>(numbers_.size()); }

 private:
  std::unordered_map<Id, int> numbers_;
};

// The rows of one frame; advances `next` past them.
std::vector<Row> TakeFrame(const std::vector<Row>& rows, int frame, std::size_t* next) {
  std::vector<Row> taken;
  for (; *next < rows.size() && rows[*next].frame == frame; ++*next) taken.push_back(rows[*next]);
  return taken;
}

}  // namespace

std::int64_t ScoredFrames::TruthRows() const {
  std::int64_t rows = 0;
  for (const ScoredFrame& frame : frames) rows += static_cast<std::int64_t>(frame.truth.size());
  return rows;
}

std::int64_t ScoredFrames::ResultRows() const {
  std::int64_t rows = 0;
  for (const ScoredFrame& frame : frames) rows += static_cast<std::int64_t>(frame.result.size());
  return rows;
}

ScoredFrames CompareTracks(const TrackScoreOptions& options, const Tracks& truth,
                           const Tracks& result) {
  CheckOptions(options);
  const std::vector<Row> truth_rows = RowsByFrame(truth), result_rows = RowsByFrame(result);
  ScoredFrames compared;
  if (truth_rows.empty() && result_rows.empty()) return compared;
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  for (const auto* rows : {&truth_rows, &result_rows}) {
    if (rows->empty()) continue;
    first = std::min(first, rows->front().frame);
    last = std::max(last, rows->back().frame);
  }

  CompactIds truth_ids, result_ids;
  std::size_t next_truth = 0, next_result = 0;
  for (int frame = first; frame <= last; ++frame) {
    std::vector<Row> in_truth = TakeFrame(truth_rows, frame, &next_truth);
    std::vector<Row> in_result = TakeFrame(result_rows, frame, &next_result);
    ScoredFrame scored;
    scored.pairs = SimilarPairs(options, in_truth, in_result);
    RemoveIgnored(options.threshold, &in_truth, &in_result, &scored.pairs);
    scored.truth = truth_ids.Of(in_truth);
    scored.result = result_ids.Of(in_result);
    compared.frames.push_back(std::move(scored));
  }
  compared.truth_ids = truth_ids.count();
  compared.result_ids = result_ids.count();
  return compared;
}

}  // namespace flocklift
