// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/solve_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <type_traits>

#include "simulate/core/check.h"
#include "simulate/core/options.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;

// Describe's visitor that takes values from a JSON object.
struct FieldTaker {
  const Json& json;

  template <typename T>
  void operator()(std::string_view name, T& value, Range, std::string_view, std::string_view) {
    const auto found = json.find(std::string(name));
    if (found == json.end()) return;
    const bool fits = std::is_same_v<T, bool> ? found->is_boolean() : found->is_number();
    Check(fits, "option " + std::string(name) + " is of the wrong kind");
    if constexpr (std::is_same_v<T, int>) {
      value = static_cast<int>(std::clamp(std::round(found->template get<double>()), -1e9, 1e9));
    } else {
      value = found->template get<T>();
    }
  }
};

struct FieldTeller {
  Json& list;
  std::string group;

  template <typename T>
  void operator()(std::string_view name, const T& value, Range range, std::string_view unit,
                  std::string_view help) {
    const auto end = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
    list.push_back({{"name", name},
                    {"group", group},
                    {"value", value},
                    {"whole", std::is_same_v<T, int>},
                    {"low", end(range.low)},
                    {"high", end(range.high)},
                    {"unit", unit},
                    {"help", help}});
  }
};

// " --flag value" for each field of `now` that differs from that of `usual`.
template <typename Options>
std::string Differences(const Options& now) {
  const Json json = OptionsAsJson(now), usual = OptionsAsJson(Options{});
  std::string text;
  for (const auto& [name, value] : json.items()) {
    if (value == usual.at(name)) continue;
    if (value.is_boolean()) {
      text += (value.template get<bool>() ? " --" : " --no-") + name;
    } else {
      text += fmt::format(" --{} {:g}", name, value.template get<double>());
    }
  }
  return text;
}

void TakeText(const Json& json, const char* name, std::string* value) {
  const auto found = json.find(name);
  if (found == json.end()) return;
  Check(found->is_string() && found->get<std::string>().size() < 200,
        std::string(name) + " must be a short text");
  *value = found->get<std::string>();
}

void TakeNumber(const Json& json, const char* name, std::optional<double>* value) {
  const auto found = json.find(name);
  if (found == json.end()) return;
  if (found->is_null()) {
    value->reset();
    return;
  }
  Check(found->is_number() && std::isfinite(found->get<double>()),
        std::string(name) + " must be a number");
  *value = found->get<double>();
}

}  // namespace

void TakeSolveOptions(const Json& json, ReconstructCommand* command) {
  Check(json.is_object(), "the options must be a JSON object");
  TakeText(json, "method", &command->method);
  // While somebody waits it is solved without forces.
  if (command->method == "auto" || command->method == "dynamics") command->method = "batch";
  if (command->method == "lin-ceres") command->method = "cobyla";
  Check(command->method == "batch" || command->method == "cobyla",
        "the method must be batch or cobyla");
  TakeText(json, "preset", &command->preset);
  TakeText(json, "speed", &command->speed);
  TakeText(json, "wingspan", &command->wingspan);
  TakeNumber(json, "near", &command->near);
  TakeNumber(json, "far", &command->far);
  TakeNumber(json, "pitch", &command->pitch_deg);
  const auto no_size = json.find("no-size");
  if (no_size != json.end()) {
    Check(no_size->is_boolean(), "no-size must be true or false");
    command->no_size = no_size->get<bool>();
  }
  if (const auto batch = json.find("batch"); batch != json.end() && batch->is_object()) {
    FieldTaker taker{*batch};
    Describe(taker, command->batch);
  }
  if (const auto cobyla = json.find("cobyla"); cobyla != json.end() && cobyla->is_object()) {
    FieldTaker taker{*cobyla};
    Describe(taker, command->cobyla);
  }
  CheckOptions(command->batch);
  CheckOptions(command->cobyla);
}

Json SolveOptionsAsJson(const ReconstructCommand& command) {
  const auto number = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
  return {{"method", command.method},
          {"preset", command.preset},
          {"speed", command.speed},
          {"wingspan", command.wingspan},
          {"near", number(command.near)},
          {"far", number(command.far)},
          {"pitch", number(command.pitch_deg)},
          {"no-size", command.no_size},
          {"batch", OptionsAsJson(command.batch)},
          {"cobyla", OptionsAsJson(command.cobyla)}};
}

Json DescribeSolveOptions(const ReconstructCommand& command) {
  Json list = Json::array();
  ReconstructCommand copy = command;
  FieldTeller batch{list, "batch"};
  Describe(batch, copy.batch);
  FieldTeller cobyla{list, "cobyla"};
  Describe(cobyla, copy.cobyla);
  return list;
}

std::string CommandLineOf(const ReconstructCommand& command) {
  std::string line = "flocklift reconstruct " + Quoted(command.tracks.string()) + " --camera " +
                     Quoted(command.camera.string()) + " --method " + command.method;
  const auto text = [&line](const char* flag, const std::string& value) {
    if (!value.empty()) line += fmt::format(" --{} {}", flag, Quoted(value));
  };
  const auto number = [&line](const char* flag, const std::optional<double>& value) {
    if (value) line += fmt::format(" --{} {:g}", flag, *value);
  };
  text("preset", command.preset);
  text("speed", command.speed);
  text("wingspan", command.wingspan);
  number("near", command.near);
  number("far", command.far);
  number("pitch", command.pitch_deg);
  text("anchors", command.anchors.string());
  if (command.no_size) line += " --no-size";
  // Batch's pixel-sd tells cobyla's segments too; the other options are of one method alone.
  line += command.method == "batch" ? Differences(command.batch) : Differences(command.cobyla);
  return line;
}

std::string Quoted(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("-_./,:=+@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

}  // namespace flocklift
