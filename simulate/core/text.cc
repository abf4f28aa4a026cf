// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace flocklift {
namespace {

bool IsSpace(char c) { return c == ' ' || c == '\t'; }

// std::from_chars refuses the plus sign that some programs write.
std::string_view WithoutPlus(std::string_view text) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return has_plus ? text.substr(1) : text;
}

}  // namespace

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsSpace(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> ParseReal(std::string_view text) {
  text = WithoutPlus(text);
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> ParseInteger(std::string_view text) {
  text = WithoutPlus(text);
  std::int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc() && stop == end) return value;
  constexpr double kExact = 9007199254740992;  // 2^53: doubles hold every integer up to it
  const std::optional<double> real = ParseReal(text);
  if (!real || std::abs(*real) > kExact || *real != std::round(*real)) return std::nullopt;
  return static_cast<std::int64_t>(*real);
}

std::string Printable(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string printable;
  for (char c : text.substr(0, kLongest)) printable += c >= ' ' && c <= '~' ? c : '?';
  return printable + (text.size() > kLongest ? "..." : "");
}

std::string Quoted(std::string_view text) { return fmt::format("`{}`", Printable(text)); }

}  // namespace flocklift
