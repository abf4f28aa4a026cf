// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the subcommands share: common flags, and flags that derive from a Describe function.

#ifndef FLOCKLIFT_TOOLS_COMMAND_H_
#define FLOCKLIFT_TOOLS_COMMAND_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "simulate/core/options.h"

namespace flocklift {

struct CommonOptions {
  std::filesystem::path out = ".";
  int threads = 0;            // 0: as many as there are cores
  std::optional<double> fps;  // overrides what files and video say [1/s]
  std::uint64_t seed = 1;
  bool quiet = false;
  bool verbose = false;
  bool json = false;   // the summary on standard output
  bool reuse = false;  // keep the outputs of an equal earlier run (set by `run`, no flag)

  int ThreadCount() const;
};

// Which of the common flags a subcommand has besides --out, --threads, --quiet, --verbose, --json.
struct CommonFlags {
  bool fps = false;
  bool seed = false;
};
void AddCommonFlags(CLI::App& command, CommonOptions& options, CommonFlags flags = {});

// Adds one subcommand whose parsed options live in a `Command`, which is told how to run.
// `footer` holds the examples. Returns the subcommand, for the flags.
template <typename Command>
CLI::App* AddSubcommand(CLI::App& app, const std::string& name, const std::string& description,
                        const std::string& footer, CommonFlags flags,
                        void (*run)(const Command&, const CommonOptions&),
                        std::shared_ptr<Command>* command) {
  CLI::App* sub = app.add_subcommand(name, description);
  auto common = std::make_shared<CommonOptions>();
  *command = std::make_shared<Command>();
  AddCommonFlags(*sub, *common, flags);
  sub->footer(footer);
  sub->callback([run, common, command = *command] { run(*command, *common); });
  return sub;
}

namespace internal {

std::string RangeText(Range range, std::string_view unit);
CLI::Validator InRange(Range range);

struct FlagAdder {
  CLI::App& command;
  std::string prefix;
  std::string group;

  template <typename T>
  void operator()(std::string_view name, T& value, Range range, std::string_view unit,
                  std::string_view help) {
    const std::string flag = "--" + prefix + std::string(name);
    if constexpr (std::is_same_v<T, bool>) {
      command.add_flag(flag + ",!--no-" + prefix + std::string(name), value, std::string(help))
          ->group(group);
    } else {
      auto* option = command.add_option(flag, value, std::string(help) + RangeText(range, unit))
                         ->capture_default_str()
                         ->group(group);
      if constexpr (std::is_arithmetic_v<T>) option->check(InRange(range));
    }
  }
};

struct JsonWriter {
  nlohmann::ordered_json& json;

  template <typename T>
  void operator()(std::string_view name, const T& value, Range, std::string_view,
                  std::string_view) {
    json[std::string(name)] = value;
  }
};

struct JsonTaker {
  const nlohmann::ordered_json& json;

  template <typename T>
  void operator()(std::string_view name, T& value, Range, std::string_view, std::string_view) {
    const auto found = json.find(std::string(name));
    if (found != json.end()) found->get_to(value);
  }
};

}  // namespace internal

// One flag per field that Describe names, in the help's section `group`. `options` must outlive
// the parse.
template <typename Options>
void AddFlags(CLI::App& command, Options& options, const std::string& group,
              const std::string& prefix = "") {
  internal::FlagAdder adder{command, prefix, group};
  Describe(adder, options);
}

// The same fields as a JSON object, for the summary.
template <typename Options>
nlohmann::ordered_json OptionsAsJson(const Options& options) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  internal::JsonWriter writer{json};
  Options copy = options;
  Describe(writer, copy);
  return json;
}

// What OptionsAsJson wrote; fields that the object lacks stay. Throws nlohmann::json::exception for
// a value of another kind.
template <typename Options>
void TakeOptions(const nlohmann::ordered_json& json, Options* options) {
  internal::JsonTaker taker{json};
  Describe(taker, *options);
}

// "MEAN[,SD]" as of --speed and --wingspan. Throws CLI::ValidationError.
struct MeanSd {
  double mean = 0;
  std::optional<double> sd;
};
MeanSd ParseMeanSd(const std::string& text, const std::string& flag);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_COMMAND_H_
