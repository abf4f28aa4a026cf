// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/still_picture.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr Vec2d kLamp{60, 50}, kLeaf{66, 50};

// One look: the sky at 200, a mask of all that is darker by 20.
struct Look {
  GrayImage smooth, mask;
  LocalBackground background;
};
Look LookAt(const std::vector<SoftBlob>& blobs) {
  Look look;
  look.smooth = DrawPicture(kWidth, kHeight, {.level = 200, .noise = 0}, blobs, 1);
  look.mask = GrayImage(kWidth, kHeight);
  for (std::size_t k = 0; k < look.mask.pixels.size(); ++k) {
    look.mask.pixels[k] = look.smooth.pixels[k] < 180 ? 255 : 0;
  }
  look.background = {.width = 1, .height = 1, .step = 200, .level = {200}, .noise = {1}};
  return look;
}

SoftBlob Thing(const Vec2d& center, double contrast = -100) {
  return {.center = center, .contrast = contrast, .major_sd = 2, .minor_sd = 2};
}

// A lamp; every third look a leaf beside it; a bird that is each time elsewhere.
StillPicture Learned(int looks) {
  StillLooks all;
  for (int k = 0; k < looks; ++k) {
    std::vector<SoftBlob> blobs{Thing(kLamp), Thing({5.0 + 3 * k, 100})};
    if (k % 3 == 0) blobs.push_back(Thing(kLeaf));
    const Look look = LookAt(blobs);
    all.Add(true, look.smooth, look.background, look.mask);
  }
  return all.Learn();
}

int At(const GrayImage& image, const Vec2d& p) {
  return image.Row(static_cast<int>(p.y))[static_cast<int>(p.x)];
}

int CleanedAt(const StillPicture& still, const std::vector<SoftBlob>& blobs, const Vec2d& p) {
  GrayImage cleaned;
  still.TakeOut(true, LookAt(blobs).smooth, &cleaned);
  return At(cleaned, p);
}

TEST(StillPictureTest, TakesOutWhatStandsAndWhatSwaysBesideIt) {
  const StillPicture still = Learned(StillLooks::kCount);
  ASSERT_FALSE(still.empty());
  const std::vector<SoftBlob> usual{Thing(kLamp), Thing(kLeaf)};
  for (const Vec2d& p : {kLamp, kLeaf, Vec2d{58, 50}, Vec2d{67, 51}}) {
    EXPECT_GE(CleanedAt(still, usual, p), 195) << p.x;
  }
  // The places where a bird was once or twice are as they were.
  for (int k = 0; k < 50; k += 7) {
    const Vec2d p{5.0 + 3 * k, 100};
    EXPECT_EQ(CleanedAt(still, {Thing(p)}, p), 100);
  }
  // A darker bird before the lamp shows by what it has more: 180 instead of 100, with the margin
  // of a tenth.
  EXPECT_NEAR(CleanedAt(still, {Thing(kLamp, -180)}, kLamp), 200 - 80 + 10, 2);
}

TEST(StillPictureTest, BrightThingsLikewise) {
  StillLooks looks;
  for (int k = 0; k < StillLooks::kCount; ++k) {
    Look look = LookAt({});
    look.smooth.Row(50)[60] = 240;
    look.mask.Row(50)[60] = 255;
    looks.Add(false, look.smooth, look.background, look.mask);
  }
  GrayImage cleaned, image = LookAt({}).smooth;
  image.Row(50)[60] = 240;
  looks.Learn().TakeOut(false, image, &cleaned);
  EXPECT_EQ(cleaned.Row(50)[60], 240 - 44);
  EXPECT_EQ(cleaned.Row(20)[20], 200);
}

TEST(StillPictureTest, AFewLooksOrAnEmptySkyTeachNothing) {
  EXPECT_TRUE(Learned(StillLooks::kCount - 1).empty());
  StillLooks looks;
  for (int k = 0; k < StillLooks::kCount; ++k) {
    const Look look = LookAt({Thing({5.0 + 3 * k, 60})});
    looks.Add(true, look.smooth, look.background, look.mask);
  }
  EXPECT_TRUE(looks.Learn().empty());
}

TEST(StillPictureTest, ForgetsWhatIsGoneAndKeepsWhatStands) {
  StillPicture still = Learned(StillLooks::kCount);
  const Look there = LookAt({Thing(kLamp)}), gone = LookAt({});
  for (int k = 0; k < 40; ++k) still.Follow(true, there.smooth, there.background, 8);
  EXPECT_GE(CleanedAt(still, {Thing(kLamp)}, kLamp), 195);
  for (int k = 0; k < 10; ++k) still.Follow(true, gone.smooth, gone.background, 8);
  still.Follow(true, there.smooth, there.background, 8);
  for (int k = 0; k < 10; ++k) still.Follow(true, gone.smooth, gone.background, 8);
  EXPECT_GE(CleanedAt(still, {Thing(kLamp)}, kLamp), 195);
  for (int k = 0; k < 10; ++k) still.Follow(true, gone.smooth, gone.background, 8);
  EXPECT_EQ(CleanedAt(still, {Thing(kLamp)}, kLamp), 100);
  EXPECT_EQ(CleanedAt(still, {Thing(kLeaf)}, kLeaf), 100);
}

TEST(StillPictureTest, IsTheSameWhenSavedAndLoaded) {
  StillPicture still = Learned(StillLooks::kCount), again;
  const Look gone = LookAt({});
  for (int k = 0; k < 10; ++k) still.Follow(true, gone.smooth, gone.background, 8);
  StateWriter out, out_again;
  still.Save(&out);
  StateReader in(out.bytes());
  again.Load(&in);
  EXPECT_TRUE(in.AtEnd());
  again.Save(&out_again);
  EXPECT_EQ(out.bytes(), out_again.bytes());
  for (StillPicture* one : {&still, &again}) {
    for (int k = 0; k < 10; ++k) one->Follow(true, gone.smooth, gone.background, 8);
    EXPECT_EQ(CleanedAt(*one, {Thing(kLamp)}, kLamp), 100);
  }
  StateWriter none;
  StillPicture().Save(&none);
  StateReader in_none(none.bytes());
  again.Load(&in_none);
  EXPECT_TRUE(again.empty());
}

}  // namespace
}  // namespace flocklift
