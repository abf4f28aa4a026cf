// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/suspicion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "simulate/core/check.h"
#include "track/predict/kalman.h"

namespace flocklift {
namespace {

constexpr double kAgility = 16;       // q of the most agile mode (motion_filter.h)
constexpr double kUsualSquared = 18;  // a step below this squared Mahalanobis distance is usual
constexpr double kSureSquared = 60;   // one so far beyond it is surely wrong
constexpr double kMostJumpChance = 0.9;
constexpr int kLongHidden = 12;  // frames
constexpr double kMergeChance = 0.25;
constexpr double kBreakChance = 0.15;
constexpr double kMarginFrames = 8;  // an animal so near to the edge, in time, may have left
constexpr double kMarginSizes = 3;
constexpr std::size_t kMostJumps = 3;  // of one track

// Steps that not even the most agile motion announces, the longest first.
void AddJumps(const MotionNoise& noise, double size, std::span<const TrackPoint> all,
              std::vector<Doubt>* doubts) {
  const double q = kAgility * noise.ProcessVariance(size);
  std::vector<Doubt> jumps;
  MotionState state{all[0].position, {0, 0}, all[0].variance, 0, noise.speed_sd * noise.speed_sd};
  for (std::size_t k = 1; k < all.size(); ++k) {
    Predict(&state, q, all[k].frame - all[k - 1].frame);
    const double squared = SquaredInnovation(state, all[k].position, all[k].variance);
    // Before the third, the velocity is not known; at the edge the centre is not.
    if (k >= 3 && squared > kUsualSquared && !all[k].edges.any() && !all[k - 1].edges.any()) {
      const double chance = std::min((squared - kUsualSquared) / kSureSquared, kMostJumpChance);
      jumps.push_back({DoubtKind::kJump, all[k - 1].frame, all[k].frame, all[k].position, chance});
    }
    Update(&state, all[k].position, all[k].variance);
  }
  std::stable_sort(jumps.begin(), jumps.end(),
                   [](const Doubt& a, const Doubt& b) { return a.chance > b.chance; });
  jumps.resize(std::min(jumps.size(), kMostJumps));
  doubts->insert(doubts->end(), jumps.begin(), jumps.end());
}

void AddMerges(std::span<const TrackPoint> all, std::vector<Doubt>* doubts) {
  for (std::size_t first = 0; first < all.size(); ++first) {
    if (!all[first].hidden) continue;
    std::size_t last = first;
    while (last + 1 < all.size() && all[last + 1].hidden) ++last;
    if (all[last].frame - all[first].frame >= kLongHidden) {
      doubts->push_back({DoubtKind::kMerge, all[first].frame, all[last].frame, all[first].position,
                         kMergeChance});
    }
    first = last;
  }
}

// Whether an animal that moves on like this is in the middle of the picture.
bool IsInside(const TrackPoint& end, const TrackPoint& before, double size,
              const internal::CameraPath& camera, const Footage& footage) {
  const Vec2d p = camera.ToImage(end.frame, end.position);
  const double frames = std::max(1, std::abs(end.frame - before.frame));
  const double margin = kMarginSizes * size + kMarginFrames / frames *
                                                  std::hypot(end.position.x - before.position.x,
                                                             end.position.y - before.position.y);
  return !end.edges.any() && p.x > margin && p.y > margin && p.x < footage.width - margin &&
         p.y < footage.height - margin;
}

void AddBreaks(const Footage& footage, const internal::CameraPath& camera, double size,
               std::span<const TrackPoint> all, std::vector<Doubt>* doubts) {
  const std::size_t some = std::min<std::size_t>(4, all.size() - 1);
  const TrackPoint &first = all.front(), &last = all.back();
  if (first.frame > footage.first_frame + 1 && IsInside(first, all[some], size, camera, footage)) {
    doubts->push_back({DoubtKind::kBreak, first.frame, first.frame, first.position, kBreakChance});
  }
  if (last.frame < footage.last_frame - 1 &&
      IsInside(last, all[all.size() - 1 - some], size, camera, footage)) {
    doubts->push_back({DoubtKind::kBreak, last.frame, last.frame, last.position, kBreakChance});
  }
}

}  // namespace

const char* NameOf(DoubtKind kind) {
  switch (kind) {
    case DoubtKind::kSwap:
      return "swap";
    case DoubtKind::kMerge:
      return "merge";
    case DoubtKind::kJoin:
      return "join";
    case DoubtKind::kJump:
      return "jump";
    case DoubtKind::kBreak:
      return "break";
  }
  return "";
}

std::vector<Doubt> DoubtsOf(const MotionNoise& noise, const Footage& footage,
                            const internal::CameraPath& camera, double size,
                            std::span<const TrackPoint> sightings) {
  FLOCKLIFT_DCHECK(!sightings.empty());
  std::vector<Doubt> doubts;
  AddJumps(noise, size, sightings, &doubts);
  AddMerges(sightings, &doubts);
  AddBreaks(footage, camera, size, sightings, &doubts);
  return doubts;
}

std::vector<Suspicion> RankSuspicions(std::span<const TrackRecord> records,
                                      std::span<const Id> ids) {
  FLOCKLIFT_DCHECK(records.size() == ids.size());
  std::map<std::tuple<DoubtKind, int, int, double, double>, Suspicion> by_place;
  for (std::size_t k = 0; k < records.size(); ++k) {
    if (ids[k] == kNoId) continue;
    for (const Doubt& d : records[k].doubts) {
      if (d.chance < kLeastDoubt) continue;
      Suspicion& s = by_place[{d.kind, d.first_frame, d.last_frame, d.position.x, d.position.y}];
      s.doubt = d;
      if (std::find(s.ids.begin(), s.ids.end(), ids[k]) == s.ids.end()) s.ids.push_back(ids[k]);
    }
  }
  std::vector<Suspicion> ranked;
  for (auto& [place, s] : by_place) ranked.push_back(std::move(s));
  std::stable_sort(ranked.begin(), ranked.end(), [](const Suspicion& a, const Suspicion& b) {
    return a.doubt.chance != b.doubt.chance ? a.doubt.chance > b.doubt.chance
                                            : a.doubt.first_frame < b.doubt.first_frame;
  });
  return ranked;
}

}  // namespace flocklift
