// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift run`: track, reconstruct, fit, replay and report in one go. A stage whose options and
// inputs have not changed since its summary was written is not done again.

#ifndef FLOCKLIFT_TOOLS_RUN_COMMAND_H_
#define FLOCKLIFT_TOOLS_RUN_COMMAND_H_

#include <CLI/CLI.hpp>

#include "tools/fit_command.h"
#include "tools/reconstruct_command.h"
#include "tools/replay_command.h"
#include "tools/track_command.h"

namespace flocklift {

struct RunCommand {
  TrackCommand track;              // the video, and how to follow its animals
  ReconstructCommand reconstruct;  // the camera, and what the user knows
  FitCommand fit;                  // the model
  ReplayCommand replay;
};

// Writes tracks.csv, shapes.csv, trajectories.csv, parameters.toml, replay/ and report.html. Where
// the flock does not permit a fit (too few animals or frames), says so and goes on to the report.
void RunRun(const RunCommand& command, const CommonOptions& common);

void AddRunCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_RUN_COMMAND_H_
