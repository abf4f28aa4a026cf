// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/input_file.h"
#include "simulate/core/model_terms.h"
#include "simulate/core/parameters.h"
#include "simulate/core/settings.h"
#include "simulate/core/suggest.h"
#include "simulate/core/text.h"

namespace flocklift {
namespace {

using internal::FailAt;
using internal::Settings;

ModelSpec ReadModel(const toml::table& table, const std::string& name) {
  Settings settings(table, name, "[model]");
  ModelSpec model;
  if (!settings.Text("name", &model.name)) settings.FailMissing("name", "name the model");
  model.where = settings.Where("name");
  if (const toml::table* parameters = settings.FindTable("parameters")) {
    Settings(*parameters, name, "[model.parameters]").AllOthers(&model);
  }
  settings.EachTable("force", [&](const toml::table& force) {
    model.terms.push_back(internal::ReadForce(force, name, "[[model.force]]"));
  });
  settings.FailUnknown();
  return model;
}

GoalSpec ReadGoal(const toml::table& table, const std::string& name) {
  Settings settings(table, name, "[[goal]]");
  GoalSpec goal;
  if (!settings.Vector("position", &goal.position, false)) {
    settings.FailMissing("position", "say where the goal is: position = [x, y, z]");
  }
  settings.Number("radius", &goal.radius, {0, 1e6});
  settings.Number("period", &goal.period, {0, 1e6});
  settings.Number("weight", &goal.weight, {0, 1e6});
  settings.FailUnknown();
  return goal;
}

class PosteriorReader {
 public:
  PosteriorReader(const toml::table& table, const std::string& name, const ModelSpec& model)
      : settings_(table, name, "[posterior]"), model_(model) {}

  ParameterPosterior Read() {
    ReadFree();
    ReadDetermined();
    ReadSd();
    ReadCorrelation();
    settings_.FailUnknown();
    return std::move(posterior_);
  }

 private:
  // The list of a key, one element for each free parameter.
  const toml::array& List(std::string_view key) {
    const toml::array* const list = settings_.FindArray(key);
    if (list == nullptr) {
      settings_.FailMissing(key, "give free, sd, correlation and determined");
    }
    CheckLength(*list, key);
    return *list;
  }

  void CheckLength(const toml::array& list, std::string_view key) const {
    if (list.size() == posterior_.free.size()) return;
    FailAt(list, settings_.name(),
           fmt::format("{} has {} elements, free has {}", key, list.size(), posterior_.free.size()),
           "give one for each free parameter");
  }

  void ReadFree() {
    const toml::array* const list = settings_.FindArray("free");
    if (list == nullptr) settings_.FailMissing("free", "name the parameters that were fitted");
    const std::vector<std::string> known = NumberNames(model_);
    for (const toml::node& node : *list) {
      if (!node.is_string()) FailAt(node, settings_.name(), "free holds no name", "give names");
      const std::string& parameter = node.as_string()->get();
      if (FindNumber(model_, parameter) == nullptr) {
        FailAt(node, settings_.name(),
               fmt::format("free names {}, which [model.parameters] lacks{}", Quoted(parameter),
                           model_.terms.empty() ? "" : ", and every [[model.force]] too"),
               SuggestName(parameter, known));
      }
      if (std::count(posterior_.free.begin(), posterior_.free.end(), parameter) > 0) {
        FailAt(node, settings_.name(), fmt::format("free names {} twice", Quoted(parameter)),
               "take one out");
      }
      posterior_.free.push_back(parameter);
    }
  }

  void ReadDetermined() {
    for (const toml::node& node : List("determined")) {
      if (!node.is_boolean()) {
        FailAt(node, settings_.name(), "determined holds no truth value", "give true or false");
      }
      posterior_.determined.push_back(node.as_boolean()->get());
    }
  }

  // Only a parameter that the data do not determine may have an infinite one.
  void ReadSd() {
    for (const toml::node& node : List("sd")) {
      const double sd = node.is_number() ? node.value<double>().value_or(NAN) : NAN;
      const bool determined = posterior_.determined[posterior_.sd.size()];
      if (!(sd >= 0) || (determined && std::isinf(sd))) {
        FailAt(node, settings_.name(), "sd holds no standard deviation",
               "give a number of at least 0, and inf only where determined is false");
      }
      posterior_.sd.push_back(sd);
    }
  }

  void ReadCorrelation() {
    const toml::array& rows = List("correlation");
    for (const toml::node& node : rows) {
      if (!node.is_array()) {
        FailAt(node, settings_.name(), "correlation holds no rows", "give a list of lists");
      }
      CheckLength(*node.as_array(), "a row of correlation");
      for (const toml::node& element : *node.as_array()) {
        posterior_.correlation.push_back(CheckedCorrelation(element));
      }
    }
    const std::size_t size = posterior_.free.size();
    for (std::size_t k = 0; k < size * size; ++k) {
      constexpr double kRounding = 1e-6;
      const std::size_t row = k / size, column = k % size;
      const double expected = row == column ? 1 : posterior_.correlation[column * size + row];
      if (std::abs(posterior_.correlation[k] - expected) <= kRounding) continue;
      FailAt(rows[row], settings_.name(),
             fmt::format("correlation is not {} at row {}, column {}",
                         row == column ? "1" : "symmetric", row + 1, column + 1),
             "give a symmetric matrix with ones on its diagonal");
    }
  }

  double CheckedCorrelation(const toml::node& node) const {
    const double value = node.is_number() ? node.value<double>().value_or(NAN) : NAN;
    if (std::abs(value) <= 1) return value;
    FailAt(node, settings_.name(), "correlation holds no number from -1 to 1",
           "give a correlation matrix");
  }

  Settings settings_;
  const ModelSpec& model_;
  ParameterPosterior posterior_;
};

// [a, b, c] of texts.
template <typename Values, typename Format>
std::string FormatList(const Values& values, const Format& format) {
  std::string list = "[";
  for (std::size_t k = 0; k < values.size(); ++k) list += (k > 0 ? ", " : "") + format(values[k]);
  return list + "]";
}

}  // namespace

Parameters ParseParameters(std::string_view text, const std::string& name) {
  const toml::table file = internal::ParseToml(text, name);
  Settings settings(file, name, "the parameters");
  const toml::table* const model = settings.FindTable("model");
  if (model == nullptr) {
    throw InputError(name, 0, "there is no table [model]", "give one with name and parameters");
  }
  Parameters parameters;
  parameters.model = ReadModel(*model, name);
  if (const toml::table* table = settings.FindTable("posterior")) {
    parameters.posterior = PosteriorReader(*table, name, parameters.model).Read();
  }
  settings.EachTable(
      "goal", [&](const toml::table& table) { parameters.goals.push_back(ReadGoal(table, name)); });
  if (const toml::table* table = settings.FindTable("world")) {
    Settings world(*table, name, "[world]");
    Region walls;
    if (world.Corners("box", &walls.low, &walls.high, false)) parameters.walls = walls;
    world.FailUnknown();
  }
  settings.FailUnknown();
  return parameters;
}

Parameters ReadParameters(const std::filesystem::path& path) {
  return ParseParameters(ReadTextFile(path), path.string());
}

std::string FormatParameters(const Parameters& parameters) {
  using internal::TomlNumber;
  using internal::TomlText;
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "[model]\nname = {}\n\n[model.parameters]\n",
                 TomlText(parameters.model.name));
  const auto settings = [&](const ModelSpec& of) {
    for (const auto& [key, value] : of.parameters) {
      fmt::format_to(out, "{} = {}\n", internal::TomlKey(key), TomlNumber(value));
    }
    for (const auto& [key, word] : of.choices) {
      fmt::format_to(out, "{} = {}\n", internal::TomlKey(key), TomlText(word));
    }
  };
  settings(parameters.model);
  for (const ModelSpec& term : parameters.model.terms) {
    fmt::format_to(out, "\n[[model.force]]\ntype = {}\n", TomlText(term.name));
    settings(term);
  }
  const ParameterPosterior& posterior = parameters.posterior;
  const std::size_t size = posterior.free.size();
  Check(posterior.sd.size() == size && posterior.determined.size() == size &&
            posterior.correlation.size() == size * size,
        "the posterior's vectors do not fit together");
  fmt::format_to(out, "\n[posterior]\nfree = {}\n", FormatList(posterior.free, TomlText));
  fmt::format_to(out, "sd = {}\ncorrelation = [", FormatList(posterior.sd, TomlNumber));
  for (std::size_t row = 0; row < size; ++row) {
    const auto first = posterior.correlation.begin() + static_cast<std::ptrdiff_t>(row * size);
    const std::vector<double> numbers(first, first + static_cast<std::ptrdiff_t>(size));
    fmt::format_to(out, "{}\n  {}", row > 0 ? "," : "", FormatList(numbers, TomlNumber));
  }
  const auto truth = [](bool value) { return std::string(value ? "true" : "false"); };
  fmt::format_to(out, "{}]\ndetermined = {}\n", size > 0 ? "\n" : "",
                 FormatList(posterior.determined, truth));
  const auto vector = [](const Vec3d& v) {
    return FormatList(std::array{v.x, v.y, v.z}, TomlNumber);
  };
  if (parameters.walls) {
    fmt::format_to(out, "\n[world]\nbox = [{}, {}]\n", vector(parameters.walls->low),
                   vector(parameters.walls->high));
  }
  for (const GoalSpec& goal : parameters.goals) {
    fmt::format_to(out, "\n[[goal]]\nposition = {}\nradius = {}\nperiod = {}\nweight = {}\n",
                   vector(goal.position), TomlNumber(goal.radius), TomlNumber(goal.period),
                   TomlNumber(goal.weight));
  }
  return text;
}

void WriteParameters(const std::filesystem::path& path, const Parameters& parameters) {
  WriteTextFile(path, FormatParameters(parameters));
}

}  // namespace flocklift
