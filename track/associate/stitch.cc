// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/stitch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "track/associate/assignment.h"
#include "track/associate/join_cost.h"

namespace flocklift {
namespace {

constexpr std::size_t kEndSightings = 15;  // of a track's end that tell its motion there
constexpr double kMassSd = 0.5;

// Motion at a track's first and last sighting.
struct Ends {
  MotionState first, last;
};

Ends EndsOf(const TrackRecord& track, const MotionNoise& noise) {
  const std::span<const TrackPoint> all(track.sightings);
  const std::size_t some = std::min(all.size(), kEndSightings);
  return {StateAtFirst(all.first(some), track.size, noise),
          StateAtLast(all.last(some), track.size, noise)};
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

}  // namespace

std::vector<TrackRecord> Stitch(const StitchOptions& options, const MotionNoise& noise,
                                double image_width, double image_height,
                                std::vector<TrackRecord> tracks, int* joins) {
  CheckOptions(options);
  *joins = 0;
  const int count = static_cast<int>(tracks.size());
  if (count < 2 || options.max_gap == 0) return tracks;

  std::vector<Ends> ends;
  int first_frame = tracks[0].sightings.front().frame, last_frame = first_frame;
  for (const TrackRecord& track : tracks) {
    ends.push_back(EndsOf(track, noise));
    last_frame = std::max(last_frame, track.sightings.back().frame);
  }
  const double beginnings = count / (image_width * image_height * (last_frame - first_frame + 1.0) *
                                     2 * std::numbers::pi * noise.speed_sd * noise.speed_sd);
  const double alone_cost = -std::log(beginnings);
  const double gate = ChiSquare4Quantile(options.gate_probability);

  std::vector<int> by_first(count);
  for (int k = 0; k < count; ++k) by_first[k] = k;
  std::stable_sort(by_first.begin(), by_first.end(), [&tracks](int a, int b) {
    return tracks[a].sightings.front().frame < tracks[b].sightings.front().frame;
  });
  std::vector<int> first_frames;
  for (const int k : by_first) first_frames.push_back(tracks[k].sightings.front().frame);

  std::vector<Candidate> candidates;
  for (int a = 0; a < count; ++a) {
    const int end = tracks[a].sightings.back().frame;
    const auto from = std::upper_bound(first_frames.begin(), first_frames.end(), end);
    for (auto it = from; it != first_frames.end() && *it - end <= options.max_gap; ++it) {
      const int b = by_first[static_cast<std::size_t>(it - first_frames.begin())];
      const double q = noise.ProcessVariance(0.5 * (tracks[a].size + tracks[b].size));
      const JoinCost join = CostOfJoin(ends[a].last, ends[b].first, q, *it - end);
      if (!(join.squared_distance <= gate)) continue;
      const double mass = std::log(tracks[a].mass / tracks[b].mass) / kMassSd;
      candidates.push_back({a, b, join.cost + std::min(0.5 * mass * mass, 8.0)});
    }
  }
  const std::vector<int> next =
      Assign(count, candidates, std::vector<double>(static_cast<std::size_t>(count), alone_cost));

  std::vector<char> continued(count, 0);
  for (const int b : next) {
    if (b >= 0) continued[b] = 1;
  }
  std::vector<TrackRecord> joined;
  for (const int k : by_first) {
    if (continued[k]) continue;
    TrackRecord track = std::move(tracks[k]);
    for (int b = next[k]; b >= 0; b = next[b]) {
      const double a_count = static_cast<double>(track.sightings.size());
      const double b_count = static_cast<double>(tracks[b].sightings.size());
      const double w = b_count / (a_count + b_count);
      track.size *= std::pow(tracks[b].size / track.size, w);
      track.mass *= std::pow(tracks[b].mass / track.mass, w);
      track.sightings.insert(track.sightings.end(), tracks[b].sightings.begin(),
                             tracks[b].sightings.end());
      ++*joins;
    }
    joined.push_back(std::move(track));
  }
  return joined;
}

}  // namespace flocklift
