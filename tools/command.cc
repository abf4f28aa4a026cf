// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/command.h"

#include <fmt/format.h>

#include <cmath>

#include "simulate/core/fps.h"
#include "simulate/core/parallel_for.h"

namespace flocklift {

int CommonOptions::ThreadCount() const { return ResolveThreads(threads); }

void AddCommonFlags(CLI::App& command, CommonOptions& options, CommonFlags flags) {
  const std::string group = "Common";
  command.add_option("--out", options.out, "folder for the outputs, made when missing")
      ->capture_default_str()
      ->group(group);
  command.add_option("--threads", options.threads, "threads; 0: one per core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->group(group);
  if (flags.fps) {
    command
        .add_option_function<std::string>(
            "--fps",
            [&options](const std::string& text) {
              options.fps = ParseFps(text);
              if (!options.fps) {
                throw CLI::ValidationError(
                    "--fps", "'" + text + "' is no frame rate; write 29.97 or 30000/1001");
              }
            },
            "frames per second, a decimal or a ratio; overrides what the files say")
        ->group(group);
  }
  if (flags.seed) {
    command.add_option("--seed", options.seed, "seed of all that is random")
        ->capture_default_str()
        ->group(group);
  }
  auto* quiet = command.add_flag("--quiet", options.quiet, "no progress, no summary")->group(group);
  command.add_flag("--verbose", options.verbose, "details on standard error")
      ->excludes(quiet)
      ->group(group);
  command.add_flag("--json", options.json, "print the summary as JSON on standard output")
      ->group(group);
}

namespace internal {

std::string RangeText(Range range, std::string_view unit) {
  std::string text;
  if (!unit.empty()) text += fmt::format(" [{}]", unit);
  const bool low = std::isfinite(range.low);
  const bool high = std::isfinite(range.high);
  if (low && high) return text + fmt::format(" ({:g} to {:g})", range.low, range.high);
  if (low) return text + fmt::format(" (at least {:g})", range.low);
  if (high) return text + fmt::format(" (at most {:g})", range.high);
  return text;
}

CLI::Validator InRange(Range range) {
  return {[range](std::string& text) -> std::string {
            double value = 0;
            if (!CLI::detail::lexical_cast(text, value)) return "'" + text + "' is not a number";
            if (value >= range.low && value <= range.high) return {};
            return fmt::format("{} is out of range{}", text, RangeText(range, ""));
          },
          ""};
}

}  // namespace internal

MeanSd ParseMeanSd(const std::string& text, const std::string& flag) {
  const auto number = [&](const std::string& part) {
    double value = 0;
    if (!CLI::detail::lexical_cast(part, value) || !std::isfinite(value) || value <= 0) {
      throw CLI::ValidationError(flag, "'" + text + "' is not MEAN or MEAN,SD, both positive");
    }
    return value;
  };
  const auto comma = text.find(',');
  MeanSd result{.mean = number(text.substr(0, comma)), .sd = {}};
  if (comma != std::string::npos) result.sd = number(text.substr(comma + 1));
  return result;
}

}  // namespace flocklift
