// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift calibrate PICTURES`: a camera file from pictures or a video of a flat board, and what
// the calibration's error does to depths.

#ifndef FLOCKLIFT_TOOLS_CALIBRATE_COMMAND_H_
#define FLOCKLIFT_TOOLS_CALIBRATE_COMMAND_H_

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "simulate/camera/calibrate.h"
#include "tools/command.h"

namespace flocklift {

struct CalibrateCommand {
  std::vector<std::filesystem::path> pictures;  // pictures; or one folder, pattern or video
  std::string board;                            // "9x6" inner corners of a chessboard
  std::string charuco;                          // "5x7" squares of a ChArUco board
  double square = 0;                            // side [m]; 0: not said
  double marker = 0;
  std::string dictionary = "DICT_4X4_50";
  int views = 40;  // at most so many of a video's frames
  CalibrateOptions options;
};

// Writes camera.yaml; prints the error of each parameter and of depth on standard output unless
// --quiet or --json.
void RunCalibrate(const CalibrateCommand& command, const CommonOptions& common);

void AddCalibrateCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_CALIBRATE_COMMAND_H_
