// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift track`: from footage to tracks.csv and shapes.csv.

#ifndef FLOCKLIFT_TOOLS_TRACK_COMMAND_H_
#define FLOCKLIFT_TOOLS_TRACK_COMMAND_H_

#include <CLI/CLI.hpp>
#include <filesystem>

#include "tools/command.h"
#include "track/tracker.h"

namespace flocklift {

struct TrackCommand {
  std::filesystem::path video = {};        // file, pattern or folder
  std::filesystem::path corrections = {};  // empty: none
  bool overlay = false;                    // write overlay.mp4
  TrackerOptions tracker = {};
};

void RunTrack(const TrackCommand& command, const CommonOptions& common);

void AddTrackCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_TRACK_COMMAND_H_
