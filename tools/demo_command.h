// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift demo`: the whole way on a synthetic scene, scored against its truth.

#ifndef FLOCKLIFT_TOOLS_DEMO_COMMAND_H_
#define FLOCKLIFT_TOOLS_DEMO_COMMAND_H_

#include <CLI/CLI.hpp>
#include <filesystem>

#include "tools/command.h"

namespace flocklift {

struct DemoCommand {
  std::filesystem::path scene;  // empty: the built-in one, data_synthetic/demo.toml
};

// Writes truth/ (as `simulate`), result/ (as `run`) and scores.json.
void RunDemo(const DemoCommand& command, const CommonOptions& common);

void AddDemoCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_DEMO_COMMAND_H_
