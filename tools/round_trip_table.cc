// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/round_trip_table.h"

#include <fmt/format.h>

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;

std::string Number(const Json& stage, const char* name, const char* format, double factor = 1) {
  const auto found = stage.find(name);
  if (found == stage.end() || !found->is_number()) return "";
  return fmt::format(fmt::runtime(format), factor * found->get<double>());
}

std::string ShareText(const Json& stage, const char* share, const char* sd) {
  if (!stage.contains(share)) return "";
  return Number(stage, share, "{:.1f}", 100) + " ± " + Number(stage, sd, "{:.1f}", 100);
}

}  // namespace

Json RoundTripAsJson(const RoundTripScores& scores) {
  Json json = {{"lead_s", scores.lead},
               {"starts", scores.starts},
               {"animals", scores.animals},
               {"error_m", scores.error},
               {"straight_on_error_m", scores.straight_on_error},
               {"image_error_px", scores.image_error},
               {"straight_on_image_error_px", scores.straight_on_image_error},
               {"stages", Json::array()}};
  for (const StageShare& s : scores.stages) {
    Json stage = {{"stage", s.stage}};
    if (s.coverage) stage["coverage"] = *s.coverage;
    if (s.error) {
      stage["error_m"] = *s.error;
      stage["share"] = s.share;
      stage["share_sd"] = s.share_sd;
    }
    stage["image_error_px"] = s.image_error;
    stage["image_share"] = s.image_share;
    stage["image_share_sd"] = s.image_share_sd;
    if (s.flock) {
      stage["polarisation_difference"] = s.flock->polarisation;
      stage["speed_difference"] = s.flock->speed;
      stage["neighbour_difference"] = s.flock->neighbour;
    }
    json["stages"].push_back(std::move(stage));
  }
  return json;
}

std::string RoundTripTable(const Json& round_trip) {
  std::string text =
      "| stage | coverage | error from here on, m | share, % | in the film, px | share, % | "
      "polarisation | speed, % | neighbours, % |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const Json& stage : round_trip.at("stages")) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
                        stage.at("stage").get<std::string>(), Number(stage, "coverage", "{:.2f}"),
                        Number(stage, "error_m", "{:.3f}"), ShareText(stage, "share", "share_sd"),
                        Number(stage, "image_error_px", "{:.1f}"),
                        ShareText(stage, "image_share", "image_share_sd"),
                        Number(stage, "polarisation_difference", "{:.3f}"),
                        Number(stage, "speed_difference", "{:.1f}", 100),
                        Number(stage, "neighbour_difference", "{:.1f}", 100));
  }
  return text;
}

}  // namespace flocklift
