// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a run's folder holds, as tables, and what of it changes while somebody looks: the tracks as
// mended, and the flock as solved again. Not safe for several threads by itself.

#ifndef FLOCKLIFT_TOOLS_VIEW_RUN_DATA_H_
#define FLOCKLIFT_TOOLS_VIEW_RUN_DATA_H_

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/reconstruct_command.h"
#include "tools/report/run_folder.h"
#include "tools/view/footage.h"
#include "tools/view/frame_table.h"
#include "tools/view/track_editor.h"

namespace flocklift {

class RunData {
 public:
  RunData(const std::filesystem::path& folder, const std::optional<std::filesystem::path>& truth,
          std::optional<double> fps);

  // "before", "after" or "truth"; null when there is none.
  const TrajectoryTable* Table(const std::string& what) const;
  const BoxTable& boxes() const { return boxes_; }

  // The command that made the trajectories, with the files as they are here.
  ReconstructCommand Command() const;

  // The tracks as mended, for a solve. Throws std::invalid_argument when there are none.
  Tracks CurrentTracks() const;
  // The editor, or std::invalid_argument with the reason why there is none.
  TrackEditor& editor();
  // After an edit: the boxes anew.
  void TracksChanged();
  void SetSolved(const Trajectories& trajectories);

  // Everything a page must know at first.
  nlohmann::ordered_json Session() const;
  nlohmann::ordered_json Versions() const;
  nlohmann::ordered_json Edits() const;

  const RunFolder& run() const { return run_; }
  const std::filesystem::path& folder() const { return run_.folder; }
  // Null when there is no footage.
  const std::shared_ptr<Footage>& footage() const { return footage_; }
  FrameSpan Span() const;

 private:
  void OpenFootage();
  void OpenEditor();

  RunFolder run_;
  AnimalList animals_;
  std::optional<TrajectoryTable> before_, after_, truth_;
  BoxTable boxes_;
  std::unique_ptr<TrackEditor> editor_;
  std::shared_ptr<Footage> footage_;
  std::string no_footage_, no_editor_;  // why, in words
  int boxes_version_ = 1, after_version_ = 0;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_RUN_DATA_H_
