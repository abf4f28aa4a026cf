// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>

#include "tools/plot/markup.h"
#include "tools/report/sections.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;

std::optional<double> NumberOf(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::string Text(const Json& object, const char* name, int decimals, double factor = 1) {
  const auto value = NumberOf(object, name);
  return value ? FixedText(factor * *value, decimals) : "";
}

std::string ShareText(const Json& stage, const char* share, const char* sd) {
  if (!NumberOf(stage, share)) return "";
  return Text(stage, share, 1, 100) + " \xC2\xB1 " + Text(stage, sd, 1, 100);
}

}  // namespace

void AddRoundTripSection(const ReportData& data, Page* page) {
  const Json& scores = data.run.scores;
  if (!scores.is_object() || !scores.contains("round_trip")) return;
  const Json& trip = scores.at("round_trip");
  if (!trip.is_object() || !trip.contains("stages") || !trip.at("stages").is_array()) return;
  page->BeginSection("round-trip", "Where the error comes from");
  page->AddText(fmt::format(
      "The flock that came out, replayed without noise from {} moments, {} s later: {} m from the "
      "truth (flying straight on: {} m), and {} px in its film ({} px). A stage's share is what "
      "the squared error falls by when the truth is put in for its output too, besides that of all "
      "stages before it. Negative: its errors offset those of later stages.",
      Text(trip, "starts", 0), Text(trip, "lead_s", 2), Text(trip, "error_m", 3),
      Text(trip, "straight_on_error_m", 3), Text(trip, "image_error_px", 1),
      Text(trip, "straight_on_image_error_px", 1)));
  std::vector<Bar> bars;
  Table table{{"stage", "coverage", "error from here on [m]", "share [%]", "in the film [px]",
               "share [%]", "polarisation", "speed [%]", "neighbours [%]"},
              {}};
  for (const Json& stage : trip.at("stages")) {
    if (!stage.is_object() || !stage.contains("stage") || !stage.at("stage").is_string()) continue;
    const std::string name = stage.at("stage").get<std::string>();
    if (const auto share = NumberOf(stage, "share")) {
      bars.push_back({.label = name,
                      .value = Text(stage, "share", 1, 100) + " %",
                      .length = std::max(0.0, *share)});
    }
    table.rows.push_back({name, Text(stage, "coverage", 2), Text(stage, "error_m", 3),
                          ShareText(stage, "share", "share_sd"), Text(stage, "image_error_px", 1),
                          ShareText(stage, "image_share", "image_share_sd"),
                          Text(stage, "polarisation_difference", 3),
                          Text(stage, "speed_difference", 1, 100),
                          Text(stage, "neighbour_difference", 1, 100)});
  }
  if (!bars.empty()) page->AddBars(bars, "Shares of the squared error in space.");
  page->AddTable(table,
                 "The chain from each stage on, with the truth before it. \xC2\xB1: one standard "
                 "deviation. Last three columns: how far the replayed flock, with its noise, is "
                 "from the true one in polarisation, median speed and median distance to the "
                 "nearest neighbour.");
}

}  // namespace flocklift
