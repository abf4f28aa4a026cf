// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/watershed.h"

#include <gtest/gtest.h>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

constexpr int kWidth = 40, kHeight = 24;

std::vector<float> Contrast(const std::vector<SoftBlob>& blobs) {
  std::vector<float> contrast(kWidth * kHeight, 0);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      double sum = 0;
      for (const SoftBlob& b : blobs) sum += std::abs(BlobValue(b, u, v));
      if (sum > 4) contrast[v * kWidth + u] = static_cast<float>(sum);
    }
  }
  return contrast;
}

int Parts(const std::vector<SoftBlob>& blobs) {
  return Watershed().Cut(Contrast(blobs), kWidth, kHeight, {});
}

TEST(WatershedTest, OnePeakStaysWhole) { EXPECT_EQ(Parts({{.center = {20.3, 11.6}}}), 1); }

TEST(WatershedTest, TwoPeaksWithADeepSaddleAreCut) {
  const std::vector<SoftBlob> blobs{{.center = {15, 12}}, {.center = {22, 12}}};
  Watershed watershed;
  ASSERT_EQ(watershed.Cut(Contrast(blobs), kWidth, kHeight, {}), 2);
  const std::vector<int>& part = watershed.part();
  EXPECT_NE(part[12 * kWidth + 15], part[12 * kWidth + 22]);
  // The cut runs half way.
  EXPECT_EQ(part[12 * kWidth + 15], part[12 * kWidth + 17]);
  EXPECT_EQ(part[12 * kWidth + 22], part[12 * kWidth + 20]);
  EXPECT_EQ(part[0], -1);
}

TEST(WatershedTest, AShallowSaddleIsNotCut) {
  // Two equal Gaussians at 2.5 sd: the saddle is at 0.9 of the peaks.
  EXPECT_EQ(Parts({{.center = {17, 12}}, {.center = {22, 12}}}), 1);
}

TEST(WatershedTest, ASpeckBesideAnAnimalIsNotCutOff) {
  EXPECT_EQ(Parts({{.center = {15, 12}, .contrast = -100, .major_sd = 3, .minor_sd = 3},
                   {.center = {25, 12}, .contrast = -30, .major_sd = 1, .minor_sd = 1}}),
            1);
}

TEST(WatershedTest, ManyPeaksOfNoiseAreNoParts) {
  // Peaks that cannot stand apart are looked over; those that can are found all the same.
  for (const int count : {1, 2}) {
    std::vector<float> contrast =
        Contrast(count == 1 ? std::vector<SoftBlob>{{.center = {15, 12}}}
                            : std::vector<SoftBlob>{{.center = {13, 12}}, {.center = {24, 12}}});
    Rng rng(3);
    for (float& c : contrast) c = c > 0 ? c + static_cast<float>(rng.Uniform(0, 3)) : 0;
    EXPECT_EQ(Watershed().Cut(contrast, kWidth, kHeight, {}), count);
  }
}

TEST(WatershedTest, NothingHasNoPart) {
  EXPECT_EQ(Watershed().Cut(std::vector<float>(12, 0.0f), 4, 3, {}), 0);
}

TEST(WatershedTest, PlateausAreOnePeak) {
  std::vector<float> contrast(kWidth * kHeight, 0);
  for (int u = 5; u < 20; ++u) contrast[12 * kWidth + u] = 50;
  EXPECT_EQ(Watershed().Cut(contrast, kWidth, kHeight, {}), 1);
}

TEST(WatershedTest, OnePatchLeavesNothingToTheNext) {
  const std::vector<float> three =
      Contrast({{.center = {8, 12}}, {.center = {16, 12}}, {.center = {24, 12}}});
  const std::vector<float> two = {30, 5, 40};
  const WatershedOptions options{.least_share = 0};
  Watershed fresh, used;
  used.Cut(three, kWidth, kHeight, options);
  ASSERT_EQ(used.Cut(two, 3, 1, options), 2);
  ASSERT_EQ(fresh.Cut(two, 3, 1, options), 2);
  EXPECT_EQ(used.part(), fresh.part());
  EXPECT_EQ(used.part(), (std::vector<int>{1, 0, 0}));
}

TEST(WatershedTest, ThreeInARow) {
  EXPECT_EQ(Parts({{.center = {8, 12}}, {.center = {16, 12}}, {.center = {24, 12}}}), 3);
}

}  // namespace
}  // namespace flocklift
