// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/crowd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

template <typename T>
class BoxesOfCrowds : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BoxesOfCrowds, Scalars);

template <typename T>
struct Places {
  std::vector<T> x, y, z;

  explicit Places(std::size_t count) {
    Rng rng(count + 1);
    for (std::vector<T>* column : {&x, &y, &z}) {
      for (std::size_t k = 0; k < count; ++k) column->push_back(static_cast<T>(rng.Normal()));
    }
  }
  Crowd<T> AsCrowd() { return {x.size(), x.data(), y.data(), z.data()}; }
};

template <typename T>
void ExpectAround(const std::vector<T>& values, T low, T high) {
  EXPECT_EQ(low, *std::min_element(values.begin(), values.end()));
  EXPECT_EQ(high, *std::max_element(values.begin(), values.end()));
}

TYPED_TEST(BoxesOfCrowds, HasTheLeastAndTheLargest) {
  for (const int threads : {1, 3}) {
    ThreadPool pool(threads);
    for (const std::size_t count : {1, 2, 3, 4, 7, 8, 15, 16, 17, 31, 33, 70, 511, 513, 3001}) {
      SCOPED_TRACE(count);
      Places<TypeParam> places(count);
      const Crowd<TypeParam> crowd = places.AsCrowd();
      const CrowdBox<TypeParam> box = Around<TypeParam>(BoxesOf<TypeParam>({&crowd, 1}, &pool));
      ExpectAround(places.x, box.low.x, box.high.x);
      ExpectAround(places.y, box.low.y, box.high.y);
      ExpectAround(places.z, box.low.z, box.high.z);
    }
  }
}

TYPED_TEST(BoxesOfCrowds, LeavesOutWhatIsNotANumber) {
  ThreadPool pool(1);
  for (const std::size_t count : {2, 9, 37}) {
    for (std::size_t at = 0; at < count; ++at) {
      Places<TypeParam> places(count);
      places.y[at] = std::numeric_limits<TypeParam>::quiet_NaN();
      const Crowd<TypeParam> crowd = places.AsCrowd();
      const CrowdBox<TypeParam> box = Around<TypeParam>(BoxesOf<TypeParam>({&crowd, 1}, &pool));
      places.y.erase(places.y.begin() + static_cast<std::ptrdiff_t>(at));
      ExpectAround(places.y, box.low.y, box.high.y);
    }
  }
}

TYPED_TEST(BoxesOfCrowds, IsAroundAllOfThem) {
  ThreadPool pool(1);
  Places<TypeParam> some(20), nobody(0), one(1);
  one.x[0] = 9;
  one.z[0] = -9;
  const std::vector<Crowd<TypeParam>> crowds = {some.AsCrowd(), nobody.AsCrowd(), one.AsCrowd()};
  const CrowdBox<TypeParam> box = Around<TypeParam>(BoxesOf<TypeParam>(crowds, &pool));
  EXPECT_EQ(box.high.x, 9);
  EXPECT_EQ(box.low.z, -9);
  EXPECT_EQ(box.low.x, *std::min_element(some.x.begin(), some.x.end()));
  const CrowdBox<TypeParam> empty =
      Around<TypeParam>(BoxesOf<TypeParam>({crowds.data() + 1, 1}, &pool));
  EXPECT_GT(empty.low.x, empty.high.x);
}

}  // namespace
}  // namespace flocklift
