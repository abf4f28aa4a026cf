// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/share_blob.h"

#include <gtest/gtest.h>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

std::vector<BlobPixel> PixelsOf(const std::vector<SoftBlob>& blobs) {
  std::vector<BlobPixel> pixels;
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < 60; ++u) {
      double sum = 0;
      for (const SoftBlob& b : blobs) sum += std::abs(BlobValue(b, u, v));
      if (sum > 3) {
        pixels.push_back({static_cast<float>(u), static_cast<float>(v), static_cast<float>(sum)});
      }
    }
  }
  return pixels;
}

Expectation Expect(const SoftBlob& b, double dx, double dy) {
  return {{b.center.x + dx, b.center.y + dy},
          1.0,
          0.05,
          b.major_sd * b.minor_sd * std::abs(b.contrast),
          MomentsOf({4 * b.major_sd, 4 * b.minor_sd, b.angle_deg, 0})};
}

double Error(const BlobShare& share, const SoftBlob& b) {
  return std::hypot(share.position.x - b.center.x, share.position.y - b.center.y);
}

TEST(ShareBlobTest, FindsTwoThatTouchFromPredictionsThatAreOff) {
  const SoftBlob a{.center = {27.2, 30.1}},
      b{.center = {33.4, 31.3}, .major_sd = 3, .minor_sd = 1.5};
  const std::vector<Expectation> expectations{Expect(a, 0.8, -0.7), Expect(b, -0.9, 0.8)};
  const std::vector<BlobShare> shares = ShareBlob(PixelsOf({a, b}), expectations);
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_LT(Error(shares[0], a), 0.4);
  EXPECT_LT(Error(shares[1], b), 0.4);
}

TEST(ShareBlobTest, FindsThree) {
  const SoftBlob a{.center = {24, 30}}, b{.center = {31, 28}}, c{.center = {29, 35}};
  const std::vector<Expectation> expectations{Expect(a, 1, 0), Expect(b, 0, -1),
                                              Expect(c, -1, 0.5)};
  const std::vector<BlobShare> shares = ShareBlob(PixelsOf({a, b, c}), expectations);
  EXPECT_LT(Error(shares[0], a), 0.4);
  EXPECT_LT(Error(shares[1], b), 0.4);
  EXPECT_LT(Error(shares[2], c), 0.4);
}

TEST(ShareBlobTest, OneOnTopOfTheOtherIsUncertain) {
  const SoftBlob near{.center = {30, 30}};
  const SoftBlob apart{.center = {38, 30}};
  const auto on_top =
      ShareBlob(PixelsOf({near, near}),
                std::vector<Expectation>{Expect(near, 0.2, 0), Expect(near, -0.2, 0)});
  const auto beside = ShareBlob(PixelsOf({near, apart}),
                                std::vector<Expectation>{Expect(near, 0, 0), Expect(apart, 0, 0)});
  EXPECT_GT(on_top[0].variance, 5 * beside[0].variance);
}

TEST(ShareBlobTest, AnAnimalFarFromAllPixelsLearnsNothing) {
  const SoftBlob a{.center = {20, 20}};
  const std::vector<Expectation> expectations{Expect(a, 0, 0),
                                              Expect({.center = {400, 400}}, 0, 0)};
  const auto shares = ShareBlob(PixelsOf({a}), expectations);
  EXPECT_LT(Error(shares[0], a), 0.1);
  EXPECT_GT(shares[1].variance, 1e5);
}

}  // namespace
}  // namespace flocklift
