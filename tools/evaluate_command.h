// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift evaluate`: how good a result is, given the truth. Writes scores.json.

#ifndef FLOCKLIFT_TOOLS_EVALUATE_COMMAND_H_
#define FLOCKLIFT_TOOLS_EVALUATE_COMMAND_H_

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "tools/command.h"
#include "tools/evaluate_files.h"
#include "tools/round_trip_scores.h"

namespace flocklift {

struct EvaluateCommand {
  std::filesystem::path truth = {}, result = {};  // two files,
  std::filesystem::path round_trip = {};          // or a folder with truth/ and result/
  std::filesystem::path camera = {};  // empty: camera.yaml beside the truth or the result
  std::string kind = "auto";          // tracks, trajectories
  std::string match = "auto";         // id, image; auto: id for files, image for a round trip
  EvaluationOptions evaluation = {};
  bool shares = true;  // of the stages of a round trip
  RoundTripOptions shares_of = {};
};

// scores.json: {"tracks": {figure: value ..}, "trajectories": {..}, "round_trip": {..}}, what there
// is of the three.
// An empty `common.out` means the folder of the round trip, or the current one.
void RunEvaluate(const EvaluateCommand& command, const CommonOptions& common);

void AddEvaluateCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_EVALUATE_COMMAND_H_
