// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/suggest.h"

namespace flocklift {
namespace {

struct Entry {
  std::string name, help, source;
  ModelParameters defaults;
};

const std::vector<Entry>& Entries() {
  static const std::vector<Entry> entries = {
      {"boids", "separation, cohesion, alignment and walls; birds at about 10 m/s, in metres",
       "UCSD CSE 167, assignment 5 (after Reynolds 1987)", BoidsParameters<double>{}},
      {"boids2d", "the same with the assignment's own numbers: pixels, and steps of 1/30 s",
       "UCSD CSE 167, assignment 5", AssignmentParameters()},
      {"lin", "separation, cohesion over all, homing; position-based", "Lin 2019",
       LinParameters<double>{}},
      {"linear", "springs and drag between all pairs, for checking estimators",
       "equations.md, section 2b", LinearParameters<double>{}}};
  return entries;
}

struct Collect {
  std::vector<ParameterInfo> infos;

  void operator()(std::string_view name, double value, Range range, std::string_view unit,
                  std::string_view help) {
    infos.push_back({std::string(name), value, range, std::string(unit), std::string(help)});
  }
};

std::string RangeText(const Range& range) {
  if (std::isinf(range.high)) {
    return std::isinf(range.low) ? "a number" : fmt::format("{} or more", range.low);
  }
  return fmt::format("{} to {}", range.low, range.high);
}

struct Assign {
  const ModelSpec& spec;

  void operator()(std::string_view name, double& value, Range range, std::string_view unit,
                  std::string_view /*help*/) {
    const auto given = spec.parameters.find(std::string(name));
    if (given == spec.parameters.end()) return;
    value = given->second;
    if (value >= range.low && value <= range.high) return;
    throw InputError(
        spec.WhereOf(given->first), 0, fmt::format("{} of model {} is {}", name, spec.name, value),
        "give " + RangeText(range) + (unit.empty() ? "" : " [" + std::string(unit) + "]"));
  }
};

}  // namespace

const std::vector<ModelInfo>& Models() {
  static const std::vector<ModelInfo> models = [] {
    std::vector<ModelInfo> result;
    for (const Entry& entry : Entries()) {
      Collect collect;
      ModelParameters defaults = entry.defaults;
      std::visit([&collect](auto& parameters) { Describe(collect, parameters); }, defaults);
      result.push_back({entry.name, entry.help, entry.source, std::move(collect.infos)});
    }
    return result;
  }();
  return models;
}

const ModelInfo* FindModel(std::string_view name) {
  for (const ModelInfo& model : Models()) {
    if (model.name == name) return &model;
  }
  return nullptr;
}

ModelParameters ResolveModel(const ModelSpec& spec) {
  const ModelInfo* const info = FindModel(spec.name);
  if (info == nullptr) {
    std::vector<std::string> names;
    for (const ModelInfo& model : Models()) names.push_back(model.name);
    throw InputError(spec.where, 0, fmt::format("there is no model `{}`", spec.name),
                     SuggestName(spec.name, names));
  }
  std::vector<std::string> names;
  for (const ParameterInfo& parameter : info->parameters) names.push_back(parameter.name);
  for (const auto& [name, value] : spec.parameters) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw InputError(spec.WhereOf(name), 0,
                     fmt::format("model {} has no parameter `{}`", spec.name, name),
                     SuggestName(name, names));
  }
  ModelParameters parameters = Entries()[static_cast<std::size_t>(info - Models().data())].defaults;
  Assign assign{spec};
  std::visit([&assign](auto& p) { Describe(assign, p); }, parameters);
  return parameters;
}

ModelSpec CompleteModel(const ModelSpec& spec) {
  ModelParameters parameters = ResolveModel(spec);
  Collect collect;
  std::visit([&collect](auto& p) { Describe(collect, p); }, parameters);
  ModelSpec complete = spec;
  for (const ParameterInfo& info : collect.infos) complete.parameters[info.name] = info.value;
  return complete;
}

}  // namespace flocklift
