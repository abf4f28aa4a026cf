// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift fit`: the interaction parameters, or kernels, behind trajectories.

#ifndef FLOCKLIFT_TOOLS_FIT_COMMAND_H_
#define FLOCKLIFT_TOOLS_FIT_COMMAND_H_

#include <CLI/CLI.hpp>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/kernel_fit.h"
#include "tools/command.h"

namespace flocklift {

struct FitCommand {
  std::filesystem::path trajectories = {};
  std::vector<std::filesystem::path> also = {};  // more films of the flock, of kernels only
  std::filesystem::path camera = {};  // empty: depth errors point away from the world's origin
  std::filesystem::path start = {};   // parameters.toml that gives what is not free
  std::filesystem::path scene = {};   // what surrounds the animals, and the model's numbers
  std::string model = "boids";
  std::vector<std::string> free = {};     // empty: every weight, or kernel
  std::vector<std::string> set = {};      // "NAME=VALUE": what is not free
  std::string walls = {};                 // "X0,Y0,Z0,X1,Y1,Z1" [m]; empty: none
  std::string goal = "auto";              // auto, none, seek, "X,Y,Z" or "X,Y,Z,REACH"
  std::string method = "auto";            // of reconstruct/fit/fit.h
  std::string search = "crs";             // of simulated statistics
  bool list = false;                      // only print what can be named
  std::vector<std::string> compare = {};  // models
  FitOptions fit = {};
  KernelFitOptions kernels = {};  // of model kernels
};

// The data do not permit a fit: too few animals or frames. Not the input's fault: exit status 1.
class CannotFit : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Writes parameters.toml, or what fit_kernels.h says. Throws CannotFit, with nothing written.
void RunFit(const FitCommand& command, const CommonOptions& common);

void AddFitCommand(CLI::App& app);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_FIT_COMMAND_H_
