// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#ifndef FLOCKLIFT_TOOLS_COMMANDS_H_
#define FLOCKLIFT_TOOLS_COMMANDS_H_

#include <CLI/CLI.hpp>

namespace flocklift {

// Adds every subcommand to the program, in the order of the help.
void AddCommands(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_COMMANDS_H_
