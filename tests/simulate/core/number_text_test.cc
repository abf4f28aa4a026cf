// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

std::string NineDigits(double value) {
  fmt::memory_buffer text;
  AppendNineDigits(value, &text);
  return fmt::to_string(text);
}

std::string Fixed(double value, int decimals) {
  fmt::memory_buffer text;
  AppendFixed(value, decimals, &text);
  return fmt::to_string(text);
}

// Numbers of any size, and those near half-way between two texts, on either side by an ulp or so.
template <typename Expect>
void ForManyNumbers(const Expect& expect) {
  for (const double value : {0.0, 0.5, 1.0, 9.99999999499, 9.999999995, 9.9999999951, 99999.99995,
                             0.1, 1e-4, 1e8, 1e9, 1e15, 1e300, 123456789.5, 1e-300, 0.00005}) {
    expect(value);
    expect(-value);
  }
  for (const double value :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(),
        std::numeric_limits<double>::denorm_min()}) {
    expect(value);
  }
  for (std::uint64_t trial = 0; trial < 4000; ++trial) {
    Rng rng(19, trial);
    const double any = rng.Normal() * std::pow(10, rng.Uniform(-7, 12));
    expect(any);
    expect(std::round(any * 1e4) / 1e4);
    for (const double unit : {1e3, 1e4, 1e5, 1e8}) {
      const double tie = (std::floor(std::abs(any) * unit) + 0.5) / unit;
      expect(tie);
      expect(std::nextafter(tie, 0.0));
      expect(std::nextafter(tie, 1e9));
    }
    const double decade = std::pow(10, static_cast<double>(rng.Below(14)) - 5);
    expect(decade);
    expect(std::nextafter(decade, 0.0));
    expect(decade * (1 - 3e-10 * rng.Uniform()));
  }
}

TEST(NumberTextTest, NineDigitsAreThoseOfPrintf) {
  ForManyNumbers([](double value) { ASSERT_EQ(NineDigits(value), fmt::format("{:.9g}", value)); });
  EXPECT_EQ(NineDigits(-12.5), "-12.5");
  EXPECT_EQ(NineDigits(0.00123456789012), "0.00123456789");
  EXPECT_EQ(NineDigits(2400), "2400");
}

TEST(NumberTextTest, DecimalsAreThoseOfPrintf) {
  for (const int decimals : {0, 1, 4, 9, 12}) {
    ForManyNumbers([&](double value) {
      ASSERT_EQ(Fixed(value, decimals), fmt::format("{:.{}f}", value, decimals));
    });
  }
  EXPECT_EQ(Fixed(-0.00001, 4), "-0.0000");
  EXPECT_EQ(Fixed(1919.99999, 4), "1920.0000");
}

TEST(NumberTextTest, IntegersOfAnySize) {
  for (const std::int64_t value :
       {std::int64_t{0}, std::int64_t{-1}, std::numeric_limits<std::int64_t>::min(),
        std::numeric_limits<std::int64_t>::max()}) {
    fmt::memory_buffer text;
    AppendInteger(value, &text);
    EXPECT_EQ(fmt::to_string(text), std::to_string(value));
  }
}

}  // namespace
}  // namespace flocklift::internal
