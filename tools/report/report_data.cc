// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <utility>

#include "tools/plot/markup.h"
#include "tools/report/sections.h"

namespace flocklift {
namespace {

constexpr std::size_t kMostMoments = 1500;  // of a series over time

std::vector<FlockStatistics> StatisticsOf(const Trajectories& trajectories) {
  const StatesByFrame states(trajectories);
  const std::size_t stride = 1 + states.frames().size() / kMostMoments;
  return ComputeFlockStatistics(states, static_cast<int>(stride));
}

}  // namespace

ReportData PrepareReport(RunFolder run_given) {
  ReportData data;
  data.run = std::move(run_given);
  const RunFolder& run = data.run;
  if (run.trajectories && run.trajectories->has_velocity) {
    data.flock = StatisticsOf(*run.trajectories);
  }
  if (run.true_trajectories && run.true_trajectories->has_velocity) {
    data.true_flock = StatisticsOf(*run.true_trajectories);
  }
  if (run.trajectories && run.true_trajectories && run.camera) {
    data.matched = MatchTrajectories({.by_image = true}, *run.camera, *run.true_trajectories,
                                     *run.trajectories);
    if (data.matched->points.empty()) data.matched.reset();
  }
  return data;
}

std::string JsonText(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "n/a";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return value.dump();
  if (value.is_number()) return NumberText(value.get<double>(), 4);
  if (value.is_string()) return value.get<std::string>();
  std::string text;
  for (const auto& [key, element] : value.items()) {
    if (!text.empty()) text += ", ";
    if (value.is_object()) text += key + ": ";
    text += element.is_structured() ? fmt::format("({})", JsonText(element)) : JsonText(element);
  }
  return text.empty() ? "none" : text;
}

}  // namespace flocklift
