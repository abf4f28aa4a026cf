// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift track`: from footage to tracks.csv and shapes.csv.

#ifndef FLOCKLIFT_TOOLS_TRACK_COMMAND_H_
#define FLOCKLIFT_TOOLS_TRACK_COMMAND_H_

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/command.h"
#include "track/interchange/foreign_tracks.h"
#include "track/tracker.h"

namespace flocklift {

struct TrackCommand {
  std::filesystem::path video = {};  // file, pattern or folder; may be empty with `from`
  std::filesystem::path from = {};   // detections or tracks of another program; empty: none
  std::string size = {};             // WIDTHxHEIGHT of the picture, where there is no video
  ForeignOptions foreign = {};
  std::filesystem::path corrections = {};  // empty: none
  std::vector<std::string> pictures = {};  // frame spans (track_picture.h)
  bool overlay = false;                    // write overlay.mp4
  TrackerOptions tracker = {};
};

void RunTrack(const TrackCommand& command, const CommonOptions& common);

void AddTrackCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_TRACK_COMMAND_H_
