// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/occupants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace flocklift {
namespace {

Expectation At(double x, double y) {
  return {.position = {x, y},
          .variance = 0.5,
          .noise = 0.1,
          .mass = 1000,
          .moments = {.xx = 4, .xy = 0, .yy = 2}};
}

// What a blob of these animals looks like if they hide nothing of each other.
Blob BlobOf(const std::vector<Expectation>& animals) {
  Blob blob;
  for (const Expectation& x : animals) {
    blob.mass += x.mass;
    blob.center.x += x.mass * x.position.x;
    blob.center.y += x.mass * x.position.y;
  }
  blob.center = {blob.center.x / blob.mass, blob.center.y / blob.mass};
  for (const Expectation& x : animals) {
    const double w = x.mass / blob.mass;
    const double dx = x.position.x - blob.center.x, dy = x.position.y - blob.center.y;
    blob.moments.xx += w * (x.moments.xx + dx * dx);
    blob.moments.xy += w * (x.moments.xy + dx * dy);
    blob.moments.yy += w * (x.moments.yy + dy * dy);
  }
  return blob;
}

using Indices = std::vector<std::size_t>;

TEST(OccupantsTest, CostByHand) {
  const std::vector<Expectation> one{At(10, 20)};
  Blob blob = BlobOf(one);
  const double s = 0.5 + 0.1 * 3;  // of the prediction, and a tenth of the mean second moment
  EXPECT_NEAR(OccupantsCost(blob, one), std::log(s), 1e-12);
  blob.center.x += 1;
  EXPECT_NEAR(OccupantsCost(blob, one), std::log(s) + 0.5 / s, 1e-12);
  blob.center.x -= 1;
  blob.mass *= std::exp(kLogMassSd);
  EXPECT_NEAR(OccupantsCost(blob, one), std::log(s) + 0.5, 1e-12);
  // Twice the variance along x: 4 KL = 4 * 1/2 (2 + 1 - 2 - ln 2).
  blob.mass = 1000;
  blob.moments.xx *= 2;
  EXPECT_NEAR(OccupantsCost(blob, one), std::log(s) + 2 * (1 - std::log(2.0)), 1e-12);
}

TEST(OccupantsTest, AnimalsApartAreAllInTheirBlob) {
  const std::vector<Expectation> three{At(10, 20), At(18, 20), At(14, 27)};
  EXPECT_EQ(FindOccupants(BlobOf(three), three), (Indices{0, 1, 2}));
}

TEST(OccupantsTest, WhoIsNotThereIsTakenOut) {
  const std::vector<Expectation> three{At(10, 20), At(18, 20), At(14, 27)};
  for (std::size_t absent = 0; absent < 3; ++absent) {
    std::vector<Expectation> two = three;
    two.erase(two.begin() + static_cast<std::ptrdiff_t>(absent));
    Indices expected;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k != absent) expected.push_back(k);
    }
    EXPECT_EQ(FindOccupants(BlobOf(two), three), expected);
    EXPECT_EQ(FindOccupants(BlobOf({three[absent]}), three), Indices{absent});
  }
}

// Where all are at one place the blob is as heavy as one, and says nothing against any.
TEST(OccupantsTest, AnimalsThatHideEachOtherStay) {
  const std::vector<Expectation> two{At(10, 20), At(10.2, 20)};
  EXPECT_EQ(FindOccupants(BlobOf({At(10.1, 20)}), two), (Indices{0, 1}));
}

}  // namespace
}  // namespace flocklift
