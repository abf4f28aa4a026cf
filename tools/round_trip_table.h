// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The shares of a round trip (round_trip_scores.h) in a file and as a table.

#ifndef FLOCKLIFT_TOOLS_ROUND_TRIP_TABLE_H_
#define FLOCKLIFT_TOOLS_ROUND_TRIP_TABLE_H_

#include <nlohmann/json.hpp>
#include <string>

#include "tools/round_trip_scores.h"

namespace flocklift {

// {"lead_s", "starts", "animals", "error_m", .., "stages": [{"stage", "error_m", "share", ..}, ..]}
nlohmann::ordered_json RoundTripAsJson(const RoundTripScores& scores);

// Markdown from that JSON: a row for each stage, in the order of the chain.
std::string RoundTripTable(const nlohmann::ordered_json& round_trip);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_ROUND_TRIP_TABLE_H_
