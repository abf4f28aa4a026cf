// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fitted interaction parameters and how sure they are: the file parameters.toml.

#ifndef FLOCKLIFT_SIMULATE_CORE_PARAMETERS_H_
#define FLOCKLIFT_SIMULATE_CORE_PARAMETERS_H_

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/core/scene.h"

namespace flocklift {

// Joint posterior of the parameters that were free; all vectors have the length of `free`,
// `correlation` is square, row-major.
struct ParameterPosterior {
  std::vector<std::string> free;
  std::vector<double> sd;  // infinite only where `determined` is false
  std::vector<double> correlation;
  std::vector<bool> determined;  // do the data say anything about it?
};

struct Parameters {
  ModelSpec model;
  ParameterPosterior posterior;
  // What the model was fitted with besides, as in a scene: [[goal]], and [world] box.
  std::vector<GoalSpec> goals = {};
  std::optional<Region> walls = {};
};

// InputError with file, line and mend. Whether the model and its parameters exist is checked where
// models are known (simulate/flock).
Parameters ReadParameters(const std::filesystem::path& path);
Parameters ParseParameters(std::string_view text, const std::string& name);
// The file's text; numbers read back as the same double.
std::string FormatParameters(const Parameters& parameters);
void WriteParameters(const std::filesystem::path& path, const Parameters& parameters);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_PARAMETERS_H_
