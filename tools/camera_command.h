// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift camera`: a camera file for footage whose lens is roughly known. World frame: z up; the
// camera stands at (0, 0, height) and looks along +y unless --position and --look-at say otherwise.

#ifndef FLOCKLIFT_TOOLS_CAMERA_COMMAND_H_
#define FLOCKLIFT_TOOLS_CAMERA_COMMAND_H_

#include <CLI/CLI.hpp>
#include <string>

#include "tools/command.h"

namespace flocklift {

struct CameraCommand {
  double fov_deg = 0;             // horizontal, over the full width
  std::string size;               // "WxH" [px]
  double pitch_deg = 0;           // of the optical axis above the horizon
  double height = 1.7;            // [m]
  std::string position, look_at;  // "X,Y,Z" [m]; both or neither
};

// Writes camera.yaml.
void RunCamera(const CameraCommand& command, const CommonOptions& common);

void AddCameraCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_CAMERA_COMMAND_H_
