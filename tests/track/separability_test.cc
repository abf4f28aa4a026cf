// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/separability.h"

#include <gtest/gtest.h>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

// `count` animals in a square of that side, each with a straight path and a little noise.
std::vector<BlobFrame> Crowd(int count, double side, double speed, int frames) {
  std::vector<BlobFrame> crowd;
  for (int frame = 1; frame <= frames; ++frame) {
    std::vector<SoftBlob> blobs;
    for (int k = 0; k < count; ++k) {
      Rng rng(1, static_cast<std::uint64_t>(k)),
          noise(2, static_cast<std::uint64_t>(k * 1000 + frame));
      const Vec2d p{rng.Uniform(0, side), rng.Uniform(0, side)};
      const Vec2d v{rng.Uniform(-speed, speed), rng.Uniform(-speed, speed)};
      blobs.push_back({.center = {p.x + v.x * frame + 0.3 * noise.Normal(),
                                  p.y + v.y * frame + 0.3 * noise.Normal()},
                       .major_sd = 0.8,
                       .minor_sd = 0.8});
    }
    crowd.push_back(BlobsOf(frame, blobs));
  }
  return crowd;
}

TEST(SeparabilityTest, BirdsFarApartAreToldApart) {
  const Separability s = MeasureSeparability(Crowd(300, 1500, 4, 40));
  EXPECT_TRUE(s.is_enough);
  EXPECT_GT(s.share, 0.5);
  EXPECT_DOUBLE_EQ(s.blobs_per_frame, 300);
}

TEST(SeparabilityTest, ADenseCrowdIsDeclined) {
  const Separability s = MeasureSeparability(Crowd(1500, 250, 6, 40));
  EXPECT_FALSE(s.is_enough);
  EXPECT_LT(s.share, kLeastSeparable);
  EXPECT_NE(WhyDeclined(s).find("cannot be told apart"), std::string::npos);
}

TEST(SeparabilityTest, SpecksAreDeclined) {
  std::vector<BlobFrame> frames = Crowd(20, 1500, 4, 40);
  EXPECT_TRUE(MeasureSeparability(frames).is_enough);
  for (BlobFrame& frame : frames) frame.specks = 900;
  const Separability s = MeasureSeparability(frames);
  EXPECT_FALSE(s.is_enough);
  EXPECT_NE(WhyDeclined(s).find("too small"), std::string::npos);
}

TEST(SeparabilityTest, FewAnimalsOrFramesAreNeverDeclined) {
  EXPECT_TRUE(MeasureSeparability(Crowd(100, 60, 6, 40)).is_enough);
  EXPECT_TRUE(MeasureSeparability(Crowd(1500, 250, 6, 12)).is_enough);
  EXPECT_TRUE(MeasureSeparability({}).is_enough);
}

}  // namespace
}  // namespace flocklift
