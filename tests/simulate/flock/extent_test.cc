// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/extent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

template <typename T>
class Extents : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Extents, Scalars);

template <typename T>
std::vector<T> Some(std::size_t count) {
  Rng rng(count + 1);
  std::vector<T> values(count);
  for (T& value : values) value = static_cast<T>(rng.Normal());
  return values;
}

TYPED_TEST(Extents, OfAnyPartOfAColumn) {
  const std::vector<TypeParam> values = Some<TypeParam>(70);
  for (std::size_t first = 0; first < 5; ++first) {
    for (std::size_t last = first + 1; last <= values.size(); ++last) {
      const auto [low, high] = std::minmax_element(values.begin() + static_cast<long>(first),
                                                   values.begin() + static_cast<long>(last));
      const Extent<TypeParam> found = ExtentOf<TypeParam>(values, first, last);
      EXPECT_EQ(found.low, *low);
      EXPECT_EQ(found.high, *high);
      EXPECT_TRUE(found.finite);
      EXPECT_EQ(ExtentOf<TypeParam>(values.data(), first, last).high, *high);
    }
  }
}

TYPED_TEST(Extents, TellThatAValueIsNotFinite) {
  using Limits = std::numeric_limits<TypeParam>;
  for (const TypeParam odd : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
    for (const std::size_t count : {1, 3, 16, 37}) {
      for (std::size_t at = 0; at < count; ++at) {
        std::vector<TypeParam> values = Some<TypeParam>(count);
        values[at] = odd;
        EXPECT_FALSE(ExtentOf<TypeParam>(values, 0, count).finite) << at << " of " << count;
      }
    }
  }
}

}  // namespace
}  // namespace flocklift
