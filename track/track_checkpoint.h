// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a killed run goes on from: a folder with the sightings so far (`sightings`, which grows all
// the time) and the state of detection and association after some frame (`state`, replaced as a
// whole, which says how much of `sightings` is of it). A state that is not of this footage, these
// options and this program is ignored.

#ifndef FLOCKLIFT_TRACK_TRACK_CHECKPOINT_H_
#define FLOCKLIFT_TRACK_TRACK_CHECKPOINT_H_

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "track/tracker.h"

namespace flocklift::internal {

// A text that other footage, options or programs do not have: names, sizes and times of the files.
std::string FingerprintOf(const TrackerOptions& options, const std::filesystem::path& footage);

class TrackCheckpoint {
 public:
  struct Saved {
    std::int64_t frame = 0;  // the last one that is in the state
    std::string state;
  };

  // An empty folder name keeps nothing.
  TrackCheckpoint(const CheckpointPlace& place, std::string fingerprint);
  // Leaves no folder from which nothing can go on.
  ~TrackCheckpoint();

  // Where the sightings go; none without a folder.
  SightingFile* sightings() { return sightings_ ? &*sightings_ : nullptr; }

  // Nothing when there is no checkpoint of this run; what is there is then removed.
  std::optional<Saved> Load();

  bool IsDue() const;
  // Throws std::runtime_error when it cannot be written.
  void Keep(std::int64_t frame, std::string_view state);

  // The run is over.
  void Remove();

 private:
  CheckpointPlace place_;
  std::string fingerprint_;
  std::optional<SightingFile> sightings_;
  bool has_state_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_TRACK_CHECKPOINT_H_
