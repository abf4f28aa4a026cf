// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift reconstruct TRACKS --camera CAMERA`: from tracks to trajectories in space.

#ifndef FLOCKLIFT_TOOLS_RECONSTRUCT_COMMAND_H_
#define FLOCKLIFT_TOOLS_RECONSTRUCT_COMMAND_H_

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "reconstruct/reconstruct.h"
#include "tools/command.h"

namespace flocklift {

struct ReconstructCommand {
  std::filesystem::path tracks, camera;
  std::filesystem::path shapes;        // empty: shapes.csv beside the tracks, when it is there
  std::filesystem::path anchors;       // empty: none
  std::filesystem::path first_depths;  // empty: none; trajectories for cobyla's first frame
  std::filesystem::path second_tracks, second_camera;  // empty: none
  std::optional<double> second_offset;                 // absent: found [s]
  std::string method = "auto";  // dynamics where the rows are few enough, else batch
  std::string preset;           // empty: none
  std::string speed, wingspan;  // "MEAN[,SD]"; empty: not known
  std::optional<double> near, far, pitch_deg;
  bool no_size = false;
  std::string output = "trajectories.csv";  // name in the out folder; .h5 for HDF5
  BatchOptions batch;
  DynamicsOptions dynamics;
  CobylaOptions cobyla;
};

// What the flags say is known, checked. Reads the anchors.
Knowledge KnowledgeOf(const ReconstructCommand& command);

void RunReconstruct(const ReconstructCommand& command, const CommonOptions& common);

void AddReconstructCommand(CLI::App& app);

// The flags that say what a user knows: --speed, --wingspan, --near, --far, --anchors, --preset,
// --no-size, --pitch. For commands that reconstruct as a part of their work.
void AddKnowledgeFlags(CLI::App& sub, ReconstructCommand* command);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_RECONSTRUCT_COMMAND_H_
