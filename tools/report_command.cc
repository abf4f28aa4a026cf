// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report_command.h"

#include <memory>
#include <optional>
#include <utility>

#include "simulate/core/atomic_file.h"
#include "tools/report/report.h"
#include "tools/stage.h"

namespace flocklift {

void RunReport(const ReportCommand& command, const CommonOptions& common_given) {
  CommonOptions common = common_given;
  if (common.out.empty()) common.out = command.folder;
  Stage stage("report", common);
  std::optional<std::filesystem::path> truth;
  if (!command.truth.empty()) truth = command.truth;
  stage.BeginPhase("read", "files");
  RunFolder run = ReadRunFolder(command.folder, truth, common.fps);
  for (const std::filesystem::path& file : run.files) stage.AddInput(file);
  if (common.fps) stage.options()["fps"] = *common.fps;
  if (stage.IsUpToDate()) return;
  stage.BeginPhase("write", "pages");
  const std::string html = MakeReport(std::move(run));
  WriteTextFile(common.out / "report.html", html);
  stage.AddOutput("report.html");
  stage.figures()["bytes"] = html.size();
  stage.Finish();
}

void AddReportCommand(CLI::App& app) {
  std::shared_ptr<ReportCommand> command;
  CLI::App* sub = AddSubcommand<ReportCommand>(
      app, "report", "Show a run's results on one self-contained page",
      "Examples:\n"
      "  flocklift report run          # writes run/report.html\n"
      "  flocklift report demo/result  # errors too: the truth lies beside it\n"
      "  flocklift report run --truth scene --out pages",
      {.fps = true}, &RunReport, &command);
  sub->get_option("--out")->default_val("")->description(
      "folder for report.html; default: the run's folder");
  sub->add_option("folder", command->folder, "folder that the other commands filled")
      ->required()
      ->option_text("DIR");
  sub->add_option("--truth", command->truth,
                  "folder with the truth (trajectories.csv, tracks_true.csv); default: truth/ in "
                  "the folder or beside it, if there")
      ->option_text("DIR");
}

}  // namespace flocklift
