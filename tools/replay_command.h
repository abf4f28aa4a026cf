// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift replay`: a reconstructed flock, flown on by a fitted model.

#ifndef FLOCKLIFT_TOOLS_REPLAY_COMMAND_H_
#define FLOCKLIFT_TOOLS_REPLAY_COMMAND_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "reconstruct/replay/replay.h"
#include "simulate/core/animal.h"
#include "simulate/core/trajectory.h"
#include "tools/command.h"

namespace flocklift {

struct ReplayCommand {
  std::filesystem::path trajectories = {}, parameters = {};
  std::filesystem::path scene = {};   // what surrounds the animals; empty: the parameters' own
  std::filesystem::path camera = {};  // empty: no video
  bool no_video = false;
  double wingspan = 0.7;   // of the animals in the video [m]
  std::string walls = {};  // "X0,Y0,Z0,X1,Y1,Z1" [m]; empty: those of the parameters
  std::vector<std::string> obstacles = {};  // as ParseObstacles of tools/walls.h reads them
  ReplayOptions replay = {};
};

// Writes trajectories.csv of the replayed flock, and video.mp4 when a camera is given.
void RunReplay(const ReplayCommand& command, const CommonOptions& common);

// Bodies to film a replay with: alike but for the phase of their wingbeats.
std::vector<Animal> BodiesOf(const Trajectories& flock, double wingspan, std::uint64_t seed);

void AddReplayCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPLAY_COMMAND_H_
