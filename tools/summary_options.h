// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From the summary of a stage back to the command that it was: its options, so that the stage can
// be run again on other inputs.

#ifndef FLOCKLIFT_TOOLS_SUMMARY_OPTIONS_H_
#define FLOCKLIFT_TOOLS_SUMMARY_OPTIONS_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/fit_command.h"
#include "tools/reconstruct_command.h"
#include "tools/track_command.h"

namespace flocklift {

// summary.STAGE.json of a folder; null where there is none with options.
nlohmann::ordered_json SummaryIn(const std::filesystem::path& folder, const std::string& stage);

// The files that it was of, by name.
std::vector<std::filesystem::path> InputsOf(const nlohmann::ordered_json& summary);

// Without their inputs, but with the file that a fit started from. A scale_sd of the fit that is
// `scale_sd`, its reconstruction's, is left out: the next reconstruction has its own. Throw
// nlohmann::json::exception for options of a wrong kind.
TrackCommand TrackCommandOf(const nlohmann::ordered_json& summary);
ReconstructCommand ReconstructCommandOf(const nlohmann::ordered_json& summary);
FitCommand FitCommandOf(const nlohmann::ordered_json& summary, std::optional<double> scale_sd);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_SUMMARY_OPTIONS_H_
