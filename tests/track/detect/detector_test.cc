// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/detector.h"

#include <gtest/gtest.h>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

constexpr int kWidth = 640, kHeight = 480;

// On a grid with jitter, so that none touch.
std::vector<SoftBlob> Scatter(double contrast, std::uint64_t seed) {
  std::vector<SoftBlob> blobs;
  Rng rng(seed);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 7; ++i) {
      blobs.push_back(
          {.center = {60 + 85 * i + rng.Uniform(-15, 15), 50 + 90 * j + rng.Uniform(-15, 15)},
           .contrast = contrast,
           .major_sd = rng.Uniform(1.5, 3),
           .minor_sd = rng.Uniform(1.2, 1.5),
           .angle_deg = rng.Uniform(0, 180)});
    }
  }
  return blobs;
}

// Distance to the nearest blob found.
double Nearest(const BlobFrame& found, const Vec2d& p, const Blob** which) {
  double nearest = 1e9;
  for (const Blob& blob : found.blobs) {
    const double d = std::hypot(blob.center.x - p.x, blob.center.y - p.y);
    if (d < nearest) {
      nearest = d;
      *which = &blob;
    }
  }
  return nearest;
}

class DetectorFindsAll : public testing::TestWithParam<double> {};

TEST_P(DetectorFindsAll, WithoutMissesFalseOnesOrBias) {
  const double contrast = GetParam();
  const Sky sky{.level = 120, .gradient_x = 0.02, .gradient_y = 0.04, .noise = 3};
  Detector detector({});
  std::vector<GrayImage> first;
  for (std::uint64_t k = 1; k <= 4; ++k)
    first.push_back(DrawPicture(kWidth, kHeight, sky, Scatter(contrast, k), k));
  ThreadPool pool(2);
  detector.Learn(first, &pool);
  EXPECT_EQ(detector.finds_dark(), contrast < 0);
  EXPECT_EQ(detector.finds_bright(), contrast > 0);
  double bias_x = 0, bias_y = 0, squared = 0, count = 0;
  for (std::uint64_t k = 5; k <= 12; ++k) {
    const auto blobs = Scatter(contrast, k);
    const BlobFrame found =
        detector.Detect(static_cast<int>(k), DrawPicture(kWidth, kHeight, sky, blobs, k));
    EXPECT_EQ(found.frame, static_cast<int>(k));
    EXPECT_EQ(found.blobs.size(), blobs.size());
    for (const SoftBlob& b : blobs) {
      const Blob* blob = nullptr;
      ASSERT_LT(Nearest(found, b.center, &blob), 0.5);
      const double dx = blob->center.x - b.center.x, dy = blob->center.y - b.center.y;
      bias_x += dx;
      bias_y += dy;
      squared += dx * dx + dy * dy;
      ++count;
      EXPECT_FALSE(blob->cut || blob->edges.any());
      EXPECT_NEAR(blob->mass, 2 * std::numbers::pi * b.major_sd * b.minor_sd * std::abs(contrast),
                  0.2 * blob->mass);
    }
  }
  EXPECT_LT(std::abs(bias_x / count), 0.02);
  EXPECT_LT(std::abs(bias_y / count), 0.02);
  EXPECT_LT(std::sqrt(squared / count), 0.15);
}

INSTANTIATE_TEST_SUITE_P(DarkAndBright, DetectorFindsAll, testing::Values(-60.0, -100.0, 60.0));

TEST(DetectorTest, ShapeIsThatOfTheBlob) {
  const SoftBlob b{.center = {320.3, 240.7}, .major_sd = 6, .minor_sd = 2.5, .angle_deg = 30};
  Detector detector({.polarity = "dark"});
  const BlobFrame found = detector.Detect(1, DrawPicture(kWidth, kHeight, {}, {b}));
  ASSERT_EQ(found.blobs.size(), 1u);
  const Shape shape = ShapeOf(found.blobs[0].moments, 0);
  EXPECT_NEAR(shape.major, 24, 1.5);
  EXPECT_NEAR(shape.minor, 10, 0.8);
  EXPECT_NEAR(shape.angle_deg, 30, 1);
  EXPECT_NEAR(found.blobs[0].center.x, 320.3, 0.05);
  EXPECT_NEAR(found.blobs[0].center.y, 240.7, 0.05);
}

TEST(DetectorTest, CloudsAndFadesDoNotFire) {
  // Clouds: soft blobs far larger than an animal, with an animal to learn from.
  std::vector<SoftBlob> scene{
      {.center = {200, 150}, .contrast = 60, .major_sd = 90, .minor_sd = 50},
      {.center = {450, 300}, .contrast = -50, .major_sd = 70, .minor_sd = 60},
      {.center = {330, 100}, .contrast = 40, .major_sd = 60, .minor_sd = 40}};
  std::vector<SoftBlob> with_animals = scene;
  for (int k = 0; k < 5; ++k)
    with_animals.push_back({.center = {100.0 + 90 * k, 60.0 + 70 * k}, .contrast = -80});
  Detector detector({});
  const Sky sky{.level = 150, .noise = 2};
  const std::vector<GrayImage> first{DrawPicture(kWidth, kHeight, sky, with_animals, 1)};
  ThreadPool pool(2);
  detector.Learn(first, &pool);
  EXPECT_TRUE(detector.finds_dark());
  EXPECT_EQ(detector.Detect(1, DrawPicture(kWidth, kHeight, sky, with_animals, 2)).blobs.size(),
            5u);
  EXPECT_TRUE(detector.Detect(2, DrawPicture(kWidth, kHeight, sky, scene, 3)).blobs.empty());
  for (const double light : {0.1, 0.4, 0.7}) {
    GrayImage faded = DrawPicture(kWidth, kHeight, sky, scene, 4);
    for (auto& pixel : faded.pixels) pixel = static_cast<std::uint8_t>(light * pixel);
    EXPECT_TRUE(detector.Detect(3, faded).blobs.empty()) << light;
  }
}

TEST(DetectorTest, CutAndEdgeBlobsAreNotWhole) {
  Detector detector({.polarity = "dark"});
  const BlobFrame found = detector.Detect(
      1, DrawPicture(kWidth, kHeight, {},
                     {{.center = {300, 200}}, {.center = {307, 200}}, {.center = {0, 100}}}));
  ASSERT_EQ(found.blobs.size(), 3u);
  for (const Blob& blob : found.blobs) EXPECT_TRUE(blob.cut || blob.edges.left);
}

TEST(DetectorTest, NoiseAloneIsEmpty) {
  Detector detector({.polarity = "both"});
  for (std::uint64_t k = 1; k <= 3; ++k) {
    EXPECT_TRUE(detector.Detect(1, DrawPicture(kWidth, kHeight, {.level = 128, .noise = 6}, {}, k))
                    .blobs.empty());
  }
}

TEST(DetectorTest, WrongOptionsAreRefused) {
  EXPECT_THROW(Detector({.polarity = "grey"}), std::invalid_argument);
  EXPECT_THROW(Detector({.threshold = -1}), std::invalid_argument);
}

TEST(DetectorTest, SeveralFramesAtATimeAreTheSame) {
  std::vector<GrayImage> pictures;
  for (std::uint64_t frame = 0; frame < 21; ++frame) {
    std::vector<SoftBlob> blobs;
    Rng rng(9, frame);
    for (int k = 0; k < 12; ++k) {  // nearer and nearer, so that what is usual changes
      blobs.push_back({.center = {rng.Uniform(20, 220), rng.Uniform(20, 140)},
                       .contrast = -60 - 2.0 * static_cast<double>(frame),
                       .major_sd = 2 + 0.1 * static_cast<double>(frame)});
    }
    pictures.push_back(DrawPicture(240, 160, {.level = 170, .noise = 2}, blobs, frame));
  }
  Detector one({});
  std::vector<BlobFrame> wanted;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    wanted.push_back(one.Detect(static_cast<int>(k) + 1, pictures[k]));
  }
  for (const int threads : {1, 2, 3}) {
    ThreadPool pool(threads);
    Detector many({});
    std::vector<BlobFrame> found;
    for (std::size_t first = 0; first < pictures.size(); first += 7) {
      for (BlobFrame& frame : many.DetectAll(static_cast<int>(first) + 1,
                                             std::span(pictures).subspan(first, 7), &pool)) {
        found.push_back(std::move(frame));
      }
    }
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].frame, wanted[k].frame);
      ASSERT_EQ(found[k].blobs.size(), wanted[k].blobs.size());
      for (std::size_t b = 0; b < found[k].blobs.size(); ++b) {
        EXPECT_EQ(found[k].blobs[b].center, wanted[k].blobs[b].center);
        EXPECT_EQ(found[k].blobs[b].mass, wanted[k].blobs[b].mass);
      }
    }
    EXPECT_EQ(many.usual_length(), one.usual_length());
    EXPECT_EQ(many.usual_contrast(), one.usual_contrast());
  }
}

}  // namespace
}  // namespace flocklift
