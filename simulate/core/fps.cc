// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/fps.h"

#include <fmt/format.h>

#include <cmath>

#include "simulate/core/text.h"

namespace flocklift {

std::optional<double> ParseFps(std::string_view text) {
  constexpr double kFastest = 1e6;
  const std::size_t slash = text.find('/');
  const std::optional<double> numerator = ParseReal(Trim(text.substr(0, slash)));
  if (!numerator) return std::nullopt;
  double fps = *numerator;
  if (slash != std::string_view::npos) {
    const std::optional<double> denominator = ParseReal(Trim(text.substr(slash + 1)));
    if (!denominator) return std::nullopt;
    fps = *numerator / *denominator;
  }
  if (!(fps > 0 && fps <= kFastest)) return std::nullopt;
  return fps;
}

std::string FormatFps(double fps) {
  const double numerator = std::round(fps * 1001);
  const bool is_ratio =
      fps != std::round(fps) && numerator / 1001 == fps && std::fmod(numerator, 1000) == 0;
  return is_ratio ? fmt::format("{:.0f}/1001", numerator) : fmt::format("{}", fps);
}

}  // namespace flocklift
