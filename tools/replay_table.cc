// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/replay_table.h"

#include <fmt/format.h>

namespace flocklift {
namespace {

std::string NumberOf(const nlohmann::ordered_json& row, const char* name) {
  const auto found = row.find(name);
  if (found == row.end() || !found->is_number()) return "";
  return fmt::format("{:.4g}", found->get<double>());
}

// "replay | reconstruction", where the two are told.
std::string Both(const nlohmann::ordered_json& statistics, double time, const char* name) {
  for (const auto& entry : statistics) {
    if (entry.at("time").get<double>() != time) continue;
    return fmt::format("{} | {}", NumberOf(entry.at("replay"), name),
                       NumberOf(entry.at("reconstruction"), name));
  }
  return "";
}

}  // namespace

std::string ReplayTable(const nlohmann::ordered_json& divergence,
                        const nlohmann::ordered_json& statistics) {
  if (divergence.empty()) return "";
  constexpr const char* kRow = "  {:>6} {:>10} {:>10} {:>12} {:>10}   {:>17} {:>17} {:>17}\n";
  std::string table =
      "  from the reconstruction, rms [m], and statistics of replay | reconstruction\n";
  table += fmt::format(fmt::runtime(kRow), "time", "replay", "noiseless", "straight on",
                       "perturbed", "polarisation", "speed [m/s]", "neighbour [m]");
  for (const auto& row : divergence) {
    const double time = row.at("time").get<double>();
    table +=
        fmt::format(fmt::runtime(kRow), fmt::format("{:.3g}", time), NumberOf(row, "model_rms"),
                    NumberOf(row, "noiseless_rms"), NumberOf(row, "straight_on_rms"),
                    NumberOf(row, "perturbed_rms"), Both(statistics, time, "polarisation"),
                    Both(statistics, time, "median_speed"),
                    Both(statistics, time, "median_neighbour_distance"));
  }
  return table;
}

}  // namespace flocklift
