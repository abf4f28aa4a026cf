// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift report`: one page of plots, pictures and figures of a run. Writes report.html.

#ifndef FLOCKLIFT_TOOLS_REPORT_COMMAND_H_
#define FLOCKLIFT_TOOLS_REPORT_COMMAND_H_

#include <CLI/CLI.hpp>
#include <filesystem>

#include "tools/command.h"

namespace flocklift {

struct ReportCommand {
  std::filesystem::path folder = {};  // of the run
  std::filesystem::path truth = {};   // empty: truth/ in the folder or beside it, if there
};

// An empty `common.out` means the run's folder.
void RunReport(const ReportCommand& command, const CommonOptions& common);

void AddReportCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPORT_COMMAND_H_
