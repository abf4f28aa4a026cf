// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/commands.h"

namespace flocklift {

void AddCommands([[maybe_unused]] CLI::App& app) {
  // AddSimulateCommand(app);
}

}  // namespace flocklift
