// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The options of `reconstruct` as JSON, as its summary writes them: from a page's sliders to a
// command, and from a command to the line that a person can copy.

#ifndef FLOCKLIFT_TOOLS_VIEW_SOLVE_OPTIONS_H_
#define FLOCKLIFT_TOOLS_VIEW_SOLVE_OPTIONS_H_

#include <nlohmann/json.hpp>
#include <string>

#include "tools/reconstruct_command.h"

namespace flocklift {

// Takes what the JSON has; unknown keys are left alone. Throws std::invalid_argument for a value of
// the wrong kind or out of its range.
void TakeSolveOptions(const nlohmann::ordered_json& json, ReconstructCommand* command);

// {"method": .., "speed": .., .., "batch": {..}, "cobyla": {..}}: all of them.
nlohmann::ordered_json SolveOptionsAsJson(const ReconstructCommand& command);

// What there is to set: [{"name", "group" ("batch", "cobyla"), "value", "low", "high", "unit",
// "help"}, ..]; ends that are not finite are null.
nlohmann::ordered_json DescribeSolveOptions(const ReconstructCommand& command);

// "flocklift reconstruct TRACKS --camera CAMERA --method .. ..": what differs from the defaults.
std::string CommandLineOf(const ReconstructCommand& command);

// A word of a shell's command line, in quotes where it must be.
std::string Quoted(const std::string& word);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_SOLVE_OPTIONS_H_
