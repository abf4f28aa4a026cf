// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/summary_options.h"

#include <fstream>

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

template <typename T>
void Take(const Json& json, const char* name, T* value) {
  const auto found = json.find(name);
  if (found != json.end()) found->get_to(*value);
}
void Take(const Json& json, const char* name, std::optional<double>* value) {
  const auto found = json.find(name);
  if (found != json.end()) *value = found->get<double>();
}

}  // namespace

Json SummaryIn(const fs::path& folder, const std::string& stage) {
  std::ifstream file(folder / ("summary." + stage + ".json"));
  if (!file) return {};
  Json summary = Json::parse(file, nullptr, /*allow_exceptions=*/false);
  return summary.is_object() && summary.contains("options") ? summary : Json();
}

std::vector<fs::path> InputsOf(const Json& summary) {
  std::vector<fs::path> inputs;
  for (const Json& input : summary.value("inputs", Json::array())) {
    inputs.emplace_back(input.value("name", ""));
  }
  return inputs;
}

TrackCommand TrackCommandOf(const Json& summary) {
  TrackCommand command;
  TakeOptions(summary.at("options"), &command.tracker);
  return command;
}

ReconstructCommand ReconstructCommandOf(const Json& summary) {
  const Json& options = summary.at("options");
  ReconstructCommand command;
  Take(options, "method", &command.method);
  Take(options, "preset", &command.preset);
  Take(options, "speed", &command.speed);
  Take(options, "wingspan", &command.wingspan);
  Take(options, "no-size", &command.no_size);
  Take(options, "near", &command.near);
  Take(options, "far", &command.far);
  Take(options, "pitch", &command.pitch_deg);
  if (options.contains("batch")) TakeOptions(options.at("batch"), &command.batch);
  if (options.contains("dynamics")) TakeOptions(options.at("dynamics"), &command.dynamics);
  if (options.contains("cobyla")) TakeOptions(options.at("cobyla"), &command.cobyla);
  return command;
}

FitCommand FitCommandOf(const Json& summary, std::optional<double> scale_sd) {
  const Json& options = summary.at("options");
  FitCommand command;
  Take(options, "model", &command.model);
  Take(options, "free", &command.free);
  Take(options, "set", &command.set);
  Take(options, "walls", &command.walls);
  Take(options, "goal", &command.goal);
  Take(options, "method", &command.method);
  Take(options, "search", &command.search);
  std::string scene;
  Take(options, "scene", &scene);
  command.scene = scene;
  if (options.contains("fit")) TakeOptions(options.at("fit"), &command.fit);
  if (scale_sd && command.fit.scale_sd == *scale_sd) command.fit.scale_sd = 0;  // each its own
  for (const fs::path& input : InputsOf(summary)) {
    if (input.extension() == ".toml" && input != command.scene) command.start = input;
  }
  return command;
}

}  // namespace flocklift
