// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// flocklift simulate SCENE: trajectories.csv, tracks_true.csv, camera.yaml, video.mp4, still.png.

#ifndef FLOCKLIFT_TOOLS_SIMULATE_COMMAND_H_
#define FLOCKLIFT_TOOLS_SIMULATE_COMMAND_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "simulate/media/video_writer.h"
#include "tools/command.h"

namespace flocklift {

struct SimulateCommand {
  std::filesystem::path scene;
  std::optional<std::uint64_t> seed;  // overrides the scene's
  bool no_video = false;
  bool no_tracks = false;       // nor look at every animal in every frame
  bool still = false;           // still.png: the last frame
  std::optional<double> until;  // ends the scene earlier [s]
  std::string size;             // "WIDTHxHEIGHT" instead of the camera's; empty: the camera's
  bool list = false;            // name the models and their parameters instead
  VideoOptions video;
};

void RunSimulate(const SimulateCommand& command, const CommonOptions& common);
void AddSimulateCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_SIMULATE_COMMAND_H_
