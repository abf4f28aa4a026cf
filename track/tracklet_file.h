// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Finished tracks, one after another, in a file that has no name; told again frame by frame, as
// tables list them. Memory: some numbers a track, and a few kilobytes for each one that is seen in
// the frame at hand.

#ifndef FLOCKLIFT_TRACK_TRACKLET_FILE_H_
#define FLOCKLIFT_TRACK_TRACKLET_FILE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "simulate/core/observations.h"
#include "track/scratch_file.h"

namespace flocklift {

class TrackletFile {
 public:
  // The file takes its room in `folder`.
  explicit TrackletFile(const std::filesystem::path& folder)
      : file_(folder / ".tracks", internal::ScratchFile::Name::kNoName) {}

  // By increasing id.
  void Add(const Tracklet& tracklet);

  void Clear();

  std::size_t size() const { return places_.size(); }
  int last_frame() const { return last_frame_; }  // of all; 0: there is none

  // By frame, then id.
  void ForEachByFrame(const std::function<void(Id, const Detection&)>& take) const;

  // Those that have rows in the frames, with these rows.
  Tracks Between(int first_frame, int last_frame) const;
  // All of them, in memory.
  std::vector<Tracklet> All() const;

 private:
  class Rows;
  struct Place {
    Id id = 0;
    std::uint64_t at = 0;  // of the first row
    std::size_t count = 0;
    int first_frame = 0, last_frame = 0;
  };

  // Which of a tracklet's rows is the first from a frame on.
  std::size_t FirstFrom(const Place& place, int frame) const;

  internal::ScratchFile file_;
  std::vector<Place> places_;
  int last_frame_ = 0;
};

// tracks.csv and shapes.csv, each whole or not at all.
void WriteTracksAndShapes(const std::filesystem::path& tracks, const std::filesystem::path& shapes,
                          std::optional<double> fps, const TrackletFile& file);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_TRACKLET_FILE_H_
