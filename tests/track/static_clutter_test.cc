// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/static_clutter.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/track/pictures.h"
#include "track/linker.h"

namespace flocklift::internal {
namespace {

constexpr Vec2d kLamp{100, 80};

SoftBlob At(const Vec2d& center) { return {.center = center}; }

// A lamp whose centre is off by some tenths, and a bird that flies on.
BlobFrame LampAndBird(int frame) {
  Rng rng(6, static_cast<std::uint64_t>(frame));
  return BlobsOf(frame, {At({kLamp.x + 0.3 * rng.Normal(), kLamp.y + 0.3 * rng.Normal()}),
                         At({20 + 2.0 * frame, 200})});
}

StaticClutter Learned(int frames) {
  std::vector<BlobFrame> first;
  for (int frame = 1; frame <= frames; ++frame) first.push_back(LampAndBird(frame));
  StaticClutter clutter;
  clutter.Learn(first);
  return clutter;
}

TEST(StaticClutterTest, TakesOutTheLampAndLeavesTheBird) {
  StaticClutter clutter = Learned(90);
  EXPECT_EQ(clutter.learned(), 1u);
  for (int frame = 91; frame <= 120; ++frame) {
    BlobFrame found = LampAndBird(frame);
    clutter.Drop(&found);
    ASSERT_EQ(found.blobs.size(), 1u);
    EXPECT_NEAR(found.blobs[0].center.y, 200, 1);
  }
}

TEST(StaticClutterTest, AFewFramesTeachNothing) {
  StaticClutter clutter = Learned(20);
  EXPECT_EQ(clutter.learned(), 0u);
  BlobFrame found = LampAndBird(21);
  clutter.Drop(&found);
  EXPECT_EQ(found.blobs.size(), 2u);
}

// Particles that diffuse, and animals that drift slowly, stay near a place for long, too.
TEST(StaticClutterTest, WhatDiffusesOrDriftsIsNone) {
  constexpr int kParticles = 60, kDrifters = 20, kFrames = 90;
  std::vector<Vec2d> particles;
  Rng rng(4);
  for (int k = 0; k < kParticles; ++k) {
    particles.push_back({20.0 + 40 * (k % 10), 20.0 + 40 * (k / 10)});
  }
  std::vector<BlobFrame> first;
  for (int frame = 1; frame <= kFrames; ++frame) {
    std::vector<SoftBlob> blobs;
    for (Vec2d& p : particles) {
      p = {p.x + 0.5 * rng.Normal(), p.y + 0.5 * rng.Normal()};
      blobs.push_back(At(p));
    }
    for (int k = 0; k < kDrifters; ++k) blobs.push_back(At({20.0 + 20 * k + 0.05 * frame, 400}));
    first.push_back(BlobsOf(frame, blobs));
  }
  StaticClutter clutter;
  clutter.Learn(first);
  EXPECT_LE(clutter.learned(), 4u);  // a particle may come back
}

// A bird before the lamp makes a heavier blob with it; one beside it is another blob.
TEST(StaticClutterTest, LeavesWhatAnAnimalShares) {
  StaticClutter clutter = Learned(90);
  BlobFrame both = BlobsOf(91, {At(kLamp), At({kLamp.x + 1, kLamp.y})});
  both.blobs = {Merged(both)};
  clutter.Drop(&both);
  EXPECT_EQ(both.blobs.size(), 1u);
  BlobFrame beside = BlobsOf(92, {At({kLamp.x + 4, kLamp.y}), At(kLamp)});
  clutter.Drop(&beside);
  ASSERT_EQ(beside.blobs.size(), 1u);
  EXPECT_NEAR(beside.blobs[0].center.x, kLamp.x + 4, 0.1);
}

TEST(StaticClutterTest, ForgetsAPlaceThatStaysEmpty) {
  StaticClutter clutter = Learned(90);
  for (int frame = 91; frame <= 200; ++frame) {
    BlobFrame empty = BlobsOf(frame, {});
    clutter.Drop(&empty);
  }
  BlobFrame found = BlobsOf(201, {At(kLamp)});
  clutter.Drop(&found);
  EXPECT_EQ(found.blobs.size(), 1u);
}

TEST(StaticClutterTest, GoesOnFromASavedState) {
  StateWriter state;
  Learned(90).Save(&state);
  StateReader reader(state.bytes());
  StaticClutter clutter;
  clutter.Load(&reader);
  EXPECT_EQ(clutter.learned(), 1u);
  BlobFrame found = LampAndBird(91);
  clutter.Drop(&found);
  EXPECT_EQ(found.blobs.size(), 1u);
}

// A tree of 300 leaves, which flicker by turns: neither tracks nor a reason to decline the birds.
TEST(StaticClutterTest, BirdsBesideATreeAreTracked) {
  constexpr int kLeaves = 300, kBirds = 10, kFrames = 150;
  const TrackerOptions options;
  Linker linker(options, 800, 600);
  for (int frame = 1; frame <= kFrames; ++frame) {
    std::vector<SoftBlob> blobs;
    for (int k = 0; k < kLeaves; ++k) {
      Rng place(8, static_cast<std::uint64_t>(k));
      Rng sway(9, static_cast<std::uint64_t>(k), static_cast<std::uint32_t>(frame));
      const Vec2d p{place.Uniform(480, 790), place.Uniform(270, 590)};
      if (sway.Uniform(0, 1) < 0.4) continue;
      blobs.push_back(At({p.x + 0.4 * sway.Normal(), p.y + 0.4 * sway.Normal()}));
    }
    for (int k = 0; k < kBirds; ++k) blobs.push_back(At({10 + 3.0 * frame, 20 + 25.0 * k}));
    linker.Add(BlobsOf(frame, blobs));
  }
  TrackerReport report;
  report.fps = 30;
  const TrackerResult result = Gather(
      report, [&](const TakeTracklet& take, TrackerReport* all) { linker.Finish(take, all); });
  EXPECT_TRUE(result.report.separability.is_enough);
  EXPECT_GT(result.report.clutter, kLeaves / 2);
  int birds = 0;
  for (const Tracklet& track : result.tracks.tracklets) {
    const bool is_bird = track.detections.front().box.left < 100;
    birds += is_bird && track.detections.size() >= kFrames - 5 ? 1 : 0;
  }
  EXPECT_EQ(birds, kBirds);
  EXPECT_LE(result.tracks.tracklets.size(), kBirds + kLeaves / 10u);  // of those that touch
}

}  // namespace
}  // namespace flocklift::internal
