// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/number_text.h"

#include <array>
#include <cmath>
#include <iterator>
#include <optional>

namespace flocklift::internal {
namespace {

constexpr std::array<double, 14> kPowers{1e0, 1e1, 1e2, 1e3,  1e4,  1e5,  1e6,
                                         1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13};

// The integer nearest to x 10^power, when rounding cannot have spoilt it; x 10^power below 1e10.
std::optional<std::uint64_t> Scaled(double x, int power) {
  constexpr double kDoubt = 1e-5;  // the product is good to 1e-6
  const double scaled = x * kPowers[static_cast<std::size_t>(power)];
  const auto whole = static_cast<std::uint64_t>(scaled);
  const double rest = scaled - static_cast<double>(whole);
  if (std::abs(rest - 0.5) < kDoubt) return std::nullopt;
  return whole + (rest > 0.5 ? 1 : 0);
}

// Writes the last `count` decimal digits of `number`, zeros in front.
void WriteDigits(std::uint64_t number, int count, char* place) {
  for (int k = count - 1; k >= 0; --k, number /= 10) {
    place[k] = static_cast<char>('0' + number % 10);
  }
}

}  // namespace

void AppendInteger(std::int64_t value, fmt::memory_buffer* text) {
  const fmt::format_int digits(value);
  text->append(digits.data(), digits.data() + digits.size());
}

void AppendNineDigits(double value, fmt::memory_buffer* text) {
  constexpr int kDigits = 9;
  const double x = std::abs(value);
  const auto slowly = [&] { fmt::format_to(std::back_inserter(*text), "{:.9g}", value); };
  if (!(x >= 1e-4 && x < 1e9)) return slowly();
  int exponent = x >= 1 ? 0 : -1;  // 10^exponent <= x < 10^(exponent + 1)
  while (exponent >= 0 && x >= kPowers[static_cast<std::size_t>(exponent) + 1]) ++exponent;
  while (exponent < 0 && x * kPowers[static_cast<std::size_t>(-exponent)] < 1) --exponent;
  const auto digits = Scaled(x, kDigits - 1 - exponent);
  if (!digits || *digits < 100'000'000 || *digits > 999'999'999) return slowly();

  std::array<char, 24> word;
  char* end = word.data();
  if (std::signbit(value)) *end++ = '-';
  char* const first = end;
  if (exponent >= 0) {
    WriteDigits(*digits, kDigits, first + 1);
    for (int k = 0; k <= exponent; ++k) first[k] = first[k + 1];
    first[exponent + 1] = '.';
    end = first + kDigits + 1;
  } else {  // 0.00ddd
    WriteDigits(*digits, kDigits - 1 - exponent, first + 2);
    first[0] = '0';
    first[1] = '.';
    end = first + 2 + kDigits - 1 - exponent;
  }
  while (end[-1] == '0') --end;
  if (end[-1] == '.') --end;
  text->append(word.data(), end);
}

void AppendFixed(double value, int decimals, fmt::memory_buffer* text) {
  const double x = std::abs(value);
  const auto slowly = [&] {
    fmt::format_to(std::back_inserter(*text), "{:.{}f}", value, decimals);
  };
  if (!(decimals > 0 && decimals <= 9 && x * kPowers[static_cast<std::size_t>(decimals)] < 1e10)) {
    return slowly();
  }
  const auto digits = Scaled(x, decimals);
  if (!digits) return slowly();
  const auto unit = static_cast<std::uint64_t>(kPowers[static_cast<std::size_t>(decimals)]);
  if (std::signbit(value)) text->push_back('-');
  AppendInteger(static_cast<std::int64_t>(*digits / unit), text);
  std::array<char, 10> word;
  word[0] = '.';
  WriteDigits(*digits % unit, decimals, word.data() + 1);
  text->append(word.data(), word.data() + 1 + decimals);
}

}  // namespace flocklift::internal
