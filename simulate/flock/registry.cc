// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/registry.h"

#include <fmt/format.h>

#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/suggest.h"

namespace flocklift::internal {
namespace {

std::string RangeText(const Range& range) {
  if (std::isinf(range.high)) {
    return std::isinf(range.low) ? "a number" : fmt::format("{} or more", range.low);
  }
  return fmt::format("{} to {}", range.low, range.high);
}

[[noreturn]] void FailSetting(const ModelSpec& spec, const std::string& kind, std::string_view name,
                              const std::string& fault, const std::string& mend) {
  throw InputError(spec.WhereOf(std::string(name)), 0,
                   fmt::format("{} of {} {} {}", name, kind, spec.name, fault), mend);
}

std::vector<std::string> Words(const Choice& choice) {
  return {choice.names.begin(), choice.names.end()};
}

}  // namespace

void CollectParameters::operator()(std::string_view name, double value, Range range,
                                   std::string_view unit, std::string_view help) {
  infos.push_back({std::string(name), value, range, std::string(unit), std::string(help), {}});
}

void CollectParameters::operator()(std::string_view name, const Choice& choice, Range /*range*/,
                                   std::string_view unit, std::string_view help) {
  infos.push_back({std::string(name),
                   static_cast<double>(choice.index),
                   {.low = 0, .high = static_cast<double>(choice.names.size()) - 1},
                   std::string(unit),
                   std::string(help),
                   Words(choice)});
}

void AssignParameters::operator()(std::string_view name, double& value, Range range,
                                  std::string_view unit, std::string_view /*help*/) {
  if (spec.choices.contains(std::string(name))) {
    FailSetting(spec, kind, name, "is a word", "give a number");
  }
  const auto given = spec.parameters.find(std::string(name));
  if (given == spec.parameters.end()) return;
  value = given->second;
  if (value >= range.low && value <= range.high) return;
  FailSetting(spec, kind, name, fmt::format("is {}", value),
              "give " + RangeText(range) + (unit.empty() ? "" : " [" + std::string(unit) + "]"));
}

void AssignParameters::operator()(std::string_view name, Choice& choice, Range /*range*/,
                                  std::string_view /*unit*/, std::string_view /*help*/) {
  if (spec.parameters.contains(std::string(name))) {
    FailSetting(spec, kind, name, "is a number",
                fmt::format("give one of \"{}\"", fmt::join(choice.names, "\", \"")));
  }
  const auto given = spec.choices.find(std::string(name));
  if (given == spec.choices.end()) return;
  for (std::size_t k = 0; k < choice.names.size(); ++k) {
    if (choice.names[k] != given->second) continue;
    choice.index = static_cast<int>(k);
    return;
  }
  FailSetting(spec, kind, name, fmt::format("is `{}`", given->second),
              SuggestName(given->second, Words(choice)));
}

void FailUnknownName(const std::string& kind, const ModelSpec& spec,
                     const std::vector<ModelInfo>& known) {
  std::vector<std::string> names;
  for (const ModelInfo& info : known) names.push_back(info.name);
  throw InputError(spec.where, 0, fmt::format("there is no {} `{}`", kind, spec.name),
                   SuggestName(spec.name, names));
}

void CheckParameterNames(const std::string& kind, const ModelSpec& spec, const ModelInfo& info) {
  std::vector<std::string> names;
  for (const ParameterInfo& parameter : info.parameters) names.push_back(parameter.name);
  const auto check = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    throw InputError(spec.WhereOf(name), 0,
                     fmt::format("{} {} has no parameter `{}`", kind, spec.name, name),
                     SuggestName(name, names));
  };
  for (const auto& [name, value] : spec.parameters) check(name);
  for (const auto& [name, word] : spec.choices) check(name);
}

}  // namespace flocklift::internal
