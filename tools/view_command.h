// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift view`: a live page of a run's folder or of a scene, served to this computer only.

#ifndef FLOCKLIFT_TOOLS_VIEW_COMMAND_H_
#define FLOCKLIFT_TOOLS_VIEW_COMMAND_H_

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

namespace flocklift {

struct ViewCommand {
  std::filesystem::path what;       // a folder or a scene
  std::filesystem::path truth;      // empty: as `report` finds it
  std::filesystem::path out_page;   // --export; empty: serve
  std::filesystem::path out = ".";  // where a scene is saved
  std::optional<double> fps;
  int port = 0;            // 0: any that is free
  int threads = 0;         // 0: one per core
  int export_width = 800;  // of the pictures in the exported page [px]
  bool quiet = false;
};

// Returns when it was interrupted (SIGINT, SIGTERM), or the page is written.
void RunView(const ViewCommand& command);

void AddViewCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_COMMAND_H_
