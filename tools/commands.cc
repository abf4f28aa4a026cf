// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/commands.h"

#include "tools/calibrate_command.h"
#include "tools/camera_command.h"
#include "tools/demo_command.h"
#include "tools/evaluate_command.h"
#include "tools/fit_command.h"
#include "tools/reconstruct_command.h"
#include "tools/replay_command.h"
#include "tools/report_command.h"
#include "tools/run_command.h"
#include "tools/simulate_command.h"
#include "tools/track_command.h"
#include "tools/view_command.h"

namespace flocklift {

void AddCommands(CLI::App& app) {
  AddSimulateCommand(app);
  AddTrackCommand(app);
  AddReconstructCommand(app);
  AddFitCommand(app);
  AddReplayCommand(app);
  AddEvaluateCommand(app);
  AddReportCommand(app);
  AddViewCommand(app);
  AddRunCommand(app);
  AddDemoCommand(app);
  AddCameraCommand(app);
  AddCalibrateCommand(app);
}

}  // namespace flocklift
