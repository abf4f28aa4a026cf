// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/stitch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "track/associate/assignment.h"
#include "track/associate/join_cost.h"
#include "track/associate/successors.h"

namespace flocklift {
namespace {

constexpr std::size_t kEndSightings = 15;  // of a track's end that tell its motion there
constexpr double kMassSd = 0.5;

// Motion at a track's first and last sighting.
struct Ends {
  MotionState first, last;
};

Ends EndsOf(const TrackRecord& track, const MotionNoise& noise) {
  return {StateAtFirst(track.sightings.First(kEndSightings), track.size, noise),
          StateAtLast(track.sightings.Last(kEndSightings), track.size, noise)};
}

double ChiSquare4Quantile(double probability) {
  // 1 - (1 + x/2) exp(-x/2) = probability, by bisection.
  double low = 0, high = 200;
  for (int k = 0; k < 60; ++k) {
    const double x = 0.5 * (low + high);
    (1 - (1 + x / 2) * std::exp(-x / 2) < probability ? low : high) = x;
  }
  return low;
}

double MassCostOf(const TrackRecord& a, const TrackRecord& b) {
  const double mass = std::log(a.mass / b.mass) / kMassSd;
  return std::min(0.5 * mass * mass, 8.0);
}

// All joins inside the gate.
std::vector<Candidate> CandidatesOf(const StitchOptions& options, const MotionNoise& noise,
                                    double gate, const std::vector<TrackRecord>& tracks,
                                    const std::vector<Ends>& ends) {
  std::vector<TrackEnd> beginnings;
  double largest = 0, most_pp = 0, most_vv = 0;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    beginnings.push_back({tracks[k].sightings.first_frame(), ends[k].first});
    largest = std::max(largest, tracks[k].size);
    most_pp = std::max(most_pp, ends[k].first.pp);
    most_vv = std::max(most_vv, ends[k].first.vv);
  }
  const Successors successors(beginnings, noise.speed_sd);
  std::vector<Candidate> candidates;
  for (std::size_t a = 0; a < tracks.size(); ++a) {
    const TrackEnd end{tracks[a].sightings.last_frame(), ends[a].last};
    // Neither position nor velocity can be farther than the gate on both together.
    const double most_q = noise.ProcessVariance(0.5 * (tracks[a].size + largest));
    const auto ahead = [&](int gap) {
      MotionState state = end.state;
      Predict(&state, most_q, gap);
      return state;
    };
    const auto reach = [&](int gap) { return std::sqrt(gate * (ahead(gap).pp + most_pp)); };
    const double speed_reach = std::sqrt(gate * (ahead(options.max_gap).vv + most_vv));
    for (const int b : successors.Find(end, options.max_gap, reach, speed_reach)) {
      const int gap = beginnings[b].frame - end.frame;
      if (gap < 1 || gap > options.max_gap) continue;
      const double q = noise.ProcessVariance(0.5 * (tracks[a].size + tracks[b].size));
      const JoinCost join = CostOfJoin(end.state, ends[b].first, q, gap);
      if (!(join.squared_distance <= gate)) continue;
      candidates.push_back({static_cast<int>(a), b, join.cost + MassCostOf(tracks[a], tracks[b])});
    }
  }
  return candidates;
}

// Of each row that was given a column: the share that its rivals, those of the column and that of
// no join at all have in the likelihood.
std::vector<double> ChancesOfError(const std::vector<Candidate>& candidates,
                                   const std::vector<int>& taken, double alone_cost) {
  std::vector<double> own(taken.size(), 0), rivals(taken.size(), 0);
  std::vector<int> row_of(taken.size(), -1);
  for (std::size_t a = 0; a < taken.size(); ++a) {
    if (taken[a] >= 0) row_of[taken[a]] = static_cast<int>(a);
  }
  for (const Candidate& c : candidates) {
    if (taken[c.row] == c.column) own[c.row] = c.cost;
  }
  for (const Candidate& c : candidates) {
    if (taken[c.row] == c.column) continue;
    for (const int a : {c.row, row_of[c.column]}) {
      if (a >= 0 && taken[a] >= 0) rivals[a] += std::exp(std::min(own[a] - c.cost, 50.0));
    }
  }
  for (std::size_t a = 0; a < taken.size(); ++a) {
    rivals[a] += std::exp(std::min(own[a] - alone_cost, 50.0));
    rivals[a] /= 1 + rivals[a];
  }
  return rivals;
}

}  // namespace

std::vector<TrackRecord> Stitch(const StitchOptions& options, const MotionNoise& noise,
                                double image_width, double image_height,
                                std::vector<TrackRecord> tracks, int* joins) {
  CheckOptions(options);
  *joins = 0;
  const int count = static_cast<int>(tracks.size());
  if (count < 2 || options.max_gap == 0) return tracks;

  std::vector<Ends> ends;
  int first_frame = tracks[0].sightings.first_frame(), last_frame = first_frame;
  for (const TrackRecord& track : tracks) {
    ends.push_back(EndsOf(track, noise));
    last_frame = std::max(last_frame, track.sightings.last_frame());
  }
  const double beginnings = count / (image_width * image_height * (last_frame - first_frame + 1.0) *
                                     2 * std::numbers::pi * noise.speed_sd * noise.speed_sd);
  const double alone_cost = -std::log(beginnings);
  const double gate = ChiSquare4Quantile(options.gate_probability);

  std::vector<int> by_first(count);
  for (int k = 0; k < count; ++k) by_first[k] = k;
  std::stable_sort(by_first.begin(), by_first.end(), [&tracks](int a, int b) {
    return tracks[a].sightings.first_frame() < tracks[b].sightings.first_frame();
  });
  const std::vector<Candidate> candidates = CandidatesOf(options, noise, gate, tracks, ends);
  const std::vector<int> next =
      Assign(count, candidates, std::vector<double>(static_cast<std::size_t>(count), alone_cost));

  const std::vector<double> chances = ChancesOfError(candidates, next, alone_cost);
  std::vector<char> continued(count, 0);
  for (const int b : next) {
    if (b >= 0) continued[b] = 1;
  }
  std::vector<TrackRecord> joined;
  for (const int k : by_first) {
    if (continued[k]) continue;
    TrackRecord track = std::move(tracks[k]);
    for (int a = k, b = next[k]; b >= 0; a = b, b = next[b]) {
      const TrackPoint before = track.sightings.Last(1).front();
      track.doubts.push_back({DoubtKind::kJoin, before.frame, tracks[b].sightings.first_frame(),
                              before.position, chances[a]});
      track.doubts.insert(track.doubts.end(), tracks[b].doubts.begin(), tracks[b].doubts.end());
      const double a_count = static_cast<double>(track.sightings.size());
      const double b_count = static_cast<double>(tracks[b].sightings.size());
      const double w = b_count / (a_count + b_count);
      track.size *= std::pow(tracks[b].size / track.size, w);
      track.mass *= std::pow(tracks[b].mass / track.mass, w);
      track.sightings.Append(std::move(tracks[b].sightings));
      ++*joins;
    }
    joined.push_back(std::move(track));
  }
  return joined;
}

}  // namespace flocklift
