// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The run of one subcommand: its progress on standard error and its summary.STAGE.json.

#ifndef FLOCKLIFT_TOOLS_STAGE_H_
#define FLOCKLIFT_TOOLS_STAGE_H_

#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/core/progress.h"
#include "tools/command.h"

namespace flocklift {

class ProgressBar;

// Use: make it, AddInput and options(), ask IsUpToDate, BeginPhase for each part of the work,
// figures(), AddOutput, Finish. Nothing is written before Finish.
class Stage {
 public:
  // `name` is the subcommand's; `common.out` is where the summary goes.
  Stage(std::string name, const CommonOptions& common);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  // A file that was read, with the SHA-256 of its bytes (for a folder: of its files' in order).
  // Throws InputError when it is not there.
  void AddInput(const std::filesystem::path& path);
  // A file in the out folder that this stage makes.
  void AddOutput(const std::string& file_name) { outputs_.push_back(file_name); }

  // What may decide the outputs' bytes: no threads, no --out.
  nlohmann::ordered_json& options() { return options_; }
  // The stage's quality figures.
  nlohmann::ordered_json& figures() { return figures_; }

  // True when the summary in the out folder is of an equal command, version, build, options and
  // inputs, and the outputs are still as it left them: then the work can be skipped
  // (`common.reuse` only).
  bool IsUpToDate() const;

  // Ends the phase before and starts one; the result reports its progress in `unit`s.
  Progress BeginPhase(const std::string& name, const std::string& unit = "frames");
  void EndPhase();
  // Takes a part of the phase that ended last, which the work itself timed, out of it and lists it
  // as a phase of its own before it.
  void SplitPhase(const std::string& name, double wall_s, double cpu_s);

  // Said on standard error (unless quiet) and kept in the summary.
  void Warn(const std::string& message);

  // Writes the summary, and prints it: JSON on standard output with --json, else a few lines on
  // standard error.
  void Finish();

 private:
  struct Phase {
    std::string name;
    double wall_s = 0, cpu_s = 0;
  };
  nlohmann::ordered_json Fingerprint() const;  // what IsUpToDate compares

  std::string name_;
  CommonOptions common_;
  nlohmann::ordered_json options_ = nlohmann::ordered_json::object();
  nlohmann::ordered_json inputs_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json figures_ = nlohmann::ordered_json::object();
  std::vector<std::string> outputs_;
  std::vector<std::string> warnings_;
  std::vector<Phase> phases_;
  std::chrono::steady_clock::time_point wall_start_;
  double cpu_start_ = 0;
  bool in_phase_ = false;
  std::unique_ptr<ProgressBar> bar_;
};

// SHA-256 of a file's bytes as lower-case hex; InputError when it cannot be read.
std::string Sha256OfFile(const std::filesystem::path& path);
std::string Sha256OfText(std::string_view text);

// Throws InputError when a needed file is not there.
void RequireFile(const std::filesystem::path& path, const std::string& mend);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_STAGE_H_
