// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flocklift {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

// Bytes of the UTF-8 character that starts `text`; 0 when it is none (overlong, surrogate, torn).
std::size_t CharacterLength(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0) != 0x80) return 0;
  }
  if (lead == 0xE0 && byte(1) < 0xA0) return 0;
  if (lead == 0xED && byte(1) >= 0xA0) return 0;
  if (lead == 0xF0 && byte(1) < 0x90) return 0;
  if (lead == 0xF4 && byte(1) >= 0x90) return 0;
  return length;
}

std::string WithTrueMinus(std::string text) {
  if (!text.empty() && text.front() == '-') {
    const bool is_zero =
        std::all_of(text.begin() + 1, text.end(), [](char c) { return c == '0' || c == '.'; });
    text.replace(0, 1, is_zero ? "" : "\xE2\x88\x92");
  }
  return text;
}

}  // namespace

std::string EscapeMarkup(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = CharacterLength(text);
    const char c = text.front();
    if (length == 0) {
      escaped += kReplacement;
      text.remove_prefix(1);
      continue;
    }
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else if (c == '\'') {
      escaped += "&#39;";
    } else if (length == 1 && (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) && c != '\n' &&
               c != '\t') {
      escaped += kReplacement;
    } else {
      escaped += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return escaped;
}

std::string NumberText(double value, int digits) {
  if (std::isnan(value)) return "n/a";
  if (std::isinf(value)) return value > 0 ? "\xE2\x88\x9E" : "\xE2\x88\x92\xE2\x88\x9E";
  const double size = std::abs(value);
  if (size == 0) return "0";
  if (size < 1e-4 || size >= 1e7) return WithTrueMinus(fmt::format("{:.{}g}", value, digits));
  const int magnitude = static_cast<int>(std::floor(std::log10(size)));
  const int decimals = std::max(0, digits - 1 - magnitude);
  std::string text = FixedText(value, decimals);
  if (decimals == 0) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string FixedText(double value, int decimals) {
  if (!std::isfinite(value)) return NumberText(value);
  return WithTrueMinus(fmt::format("{:.{}f}", value, decimals));
}

std::string Coordinate(double px) {
  const double tenths = std::round(px * 10);
  if (tenths == 0 || !std::isfinite(tenths)) return "0";
  const double whole = std::trunc(tenths / 10);
  return whole * 10 == tenths ? fmt::format("{:.0f}", whole) : fmt::format("{:.1f}", tenths / 10);
}

}  // namespace flocklift
