// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a run's folder holds, and what of it changes while somebody looks: the tracks as mended, and
// the flock as solved again. Small files are read when the folder is opened. Of large ones whose
// rows stand by frame, the frames that are asked for are read when they are asked for, and the rest
// is left to the LateReader. Not safe for several threads by itself, but what is const may be
// called by several at once.

#ifndef FLOCKLIFT_TOOLS_VIEW_RUN_DATA_H_
#define FLOCKLIFT_TOOLS_VIEW_RUN_DATA_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "tools/reconstruct_command.h"
#include "tools/report/run_folder.h"
#include "tools/view/flock_rows.h"
#include "tools/view/footage.h"
#include "tools/view/frame_table.h"
#include "tools/view/track_editor.h"

namespace flocklift {

struct RunDataOptions {
  std::filesystem::path folder = {};
  std::optional<std::filesystem::path> truth = {};  // not given: as `report` finds it
  std::optional<double> fps = {};
  std::uint64_t large_bytes = std::uint64_t{16}
                              << 20;  // files from this size on are not read whole
};

class RunData {
 public:
  explicit RunData(const RunDataOptions& options);

  // The rows of frames `first` to `last` as bytes (frame_table.h); `what` is "boxes", "before",
  // "after" or "truth". Throws InputError when they are damaged.
  std::string Window(const std::string& what, int first, int last) const;
  // The rows that curves are drawn of: all, or those of every n-th frame of a large flock.
  const TrajectoryTable& Curves(const std::string& what) const;

  // What is not in memory: the file of the tracks, if so, and "before" or "truth" (null: none).
  const std::optional<TableByFrame>& track_file() const { return track_file_; }
  const FlockRows* FlockOf(const std::string& what) const;
  // As columns; of all that is const here, what takes longest for a large sample.
  TrajectoryTable CurvesOf(const Trajectories& sample) const;
  // What the LateReader found. Nobody is answered meanwhile, so none of it takes long.
  void SetTracks(Tracks tracks);
  void SetNoTracks(const std::string& reason);
  void SetFlock(const std::string& what, FlockRows rows);
  void SetCurves(const std::string& what, TrajectoryTable curves);
  void AddAnimals(const std::vector<Id>& ids) const;

  // The command that made the trajectories, with the files as they are here.
  ReconstructCommand Command() const;

  // The tracks as mended. Throws std::invalid_argument, with the reason, when they are not there.
  const TrackList& CurrentTracks() const;
  std::vector<Correction> Corrections() const;  // in force, besides those of the tracker
  // The tracker's own list of doubts; null when it left none.
  const nlohmann::ordered_json& TrackerDoubts() const;
  // The editor, or std::invalid_argument with the reason why there is none.
  TrackEditor& editor();
  void TracksChanged();  // by an edit
  void SetSolved(const Trajectories& trajectories);

  // Everything a page must know at first.
  nlohmann::ordered_json Session() const;
  nlohmann::ordered_json Versions() const;
  std::size_t animal_count() const;
  nlohmann::ordered_json Edits() const;

  const RunFolder& run() const { return run_; }
  const std::filesystem::path& folder() const { return run_.folder; }
  // Null when there is no footage.
  const std::shared_ptr<Footage>& footage() const { return footage_; }
  FrameSpan Span() const;

 private:
  struct Flock {
    FlockRows rows;
    TrajectoryTable curves;
  };
  void OpenTables(const RunDataOptions& options);
  void OpenFootage();
  void OpenEditor();
  const std::optional<Flock>& Find(const std::string& what) const;
  template <typename Rows>
  std::string Packed(const Rows& rows, int first, int last) const;

  RunFolder run_;
  mutable std::shared_mutex animals_mutex_;
  mutable AnimalList animals_;  // grows by whatever is come across
  std::optional<Flock> before_, after_, truth_;
  std::optional<TableByFrame> track_file_;  // until they are read
  TrackList tracks_;
  std::optional<double> tracks_fps_;
  std::unique_ptr<TrackEditor> editor_;
  std::shared_ptr<Footage> footage_;
  std::string no_footage_, no_tracks_, no_editor_;  // why, in words
  int boxes_version_ = 1, before_version_ = 1, after_version_ = 0, curves_version_ = 1;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_RUN_DATA_H_
