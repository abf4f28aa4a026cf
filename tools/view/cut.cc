// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/cut.h"

#include <algorithm>
#include <utility>

namespace flocklift {
namespace {

template <typename Row>
std::vector<Row> CutRows(const std::vector<Row>& rows, int first, int last) {
  const auto begin = std::lower_bound(rows.begin(), rows.end(), first,
                                      [](const Row& row, int frame) { return row.frame < frame; });
  const auto end = std::upper_bound(begin, rows.end(), last,
                                    [](int frame, const Row& row) { return frame < row.frame; });
  return {begin, end};
}

}  // namespace

TrackList Shared(Tracks tracks) {
  TrackList list;
  for (Tracklet& t : tracks.tracklets) {
    list.push_back(std::make_shared<const Tracklet>(std::move(t)));
  }
  return list;
}

Tracks AsTracks(const TrackList& list) {
  Tracks tracks;
  tracks.tracklets.reserve(list.size());
  for (const auto& t : list) tracks.tracklets.push_back(*t);
  return tracks;
}

Tracks Cut(const TrackList& tracks, int first, int last) {
  Tracks part;
  for (const auto& t : tracks) {
    std::vector<Detection> rows = CutRows(t->detections, first, last);
    if (!rows.empty()) part.tracklets.push_back({t->id, std::move(rows)});
  }
  return part;
}

Trajectories Cut(const Trajectories& trajectories, int first, int last) {
  Trajectories part{.fps = trajectories.fps,
                    .has_velocity = trajectories.has_velocity,
                    .has_orientation = trajectories.has_orientation,
                    .has_sd_depth = trajectories.has_sd_depth,
                    .trajectories = {}};
  for (const Trajectory& t : trajectories.trajectories) {
    std::vector<TrajectoryPoint> rows = CutRows(t.points, first, last);
    if (!rows.empty()) part.trajectories.push_back({t.id, std::move(rows)});
  }
  return part;
}

}  // namespace flocklift
