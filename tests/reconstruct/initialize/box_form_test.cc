// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/box_form.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulate/camera/projection.h"

namespace flocklift {
namespace {

Detection Seen(int frame, double width, double height, double confidence = 1) {
  Detection detection;
  detection.frame = frame;
  detection.box = Box::Around({400, 300}, width, height);
  detection.confidence = confidence;
  return detection;
}

class FormOfBoxesTest : public testing::Test {
 protected:
  Camera camera_ = PinholeCamera(60, 800, 600);
  Tracks tracks_;
};

TEST_F(FormOfBoxesTest, ByHand) {
  tracks_.tracklets = {{1, {Seen(1, 10, 10), Seen(2, 40, 10)}}, {2, {Seen(1, 5, 10)}}};
  const BoxForm form = FormOfBoxes(tracks_, camera_);
  EXPECT_NEAR(form.sd, std::log(4) / std::sqrt(2), 1e-12);
  EXPECT_NEAR(form.log_diagonal,
              (std::log(std::sqrt(2.0)) + std::log(std::sqrt(1700.0) / 40) +
               std::log(std::sqrt(125.0) / 10)) /
                  3,
              1e-12);
}

TEST_F(FormOfBoxesTest, SizeIsNoForm) {
  tracks_.tracklets = {{1, {Seen(1, 30, 10), Seen(2, 60, 20), Seen(3, 3, 1)}}};
  EXPECT_NEAR(FormOfBoxes(tracks_, camera_).sd, 0, 1e-12);
}

TEST_F(FormOfBoxesTest, OnlyWholeMeasuredBoxesCount) {
  tracks_.tracklets = {{1, {Seen(1, 30, 10), Seen(2, 60, 20)}}};
  const BoxForm before = FormOfBoxes(tracks_, camera_);
  Detection cut = Seen(3, 10, 30);
  cut.box.left = 0;
  ASSERT_TRUE(IsCutOff(cut.box, camera_));
  tracks_.tracklets[0].detections.push_back(cut);
  tracks_.tracklets[0].detections.push_back(Seen(4, 10, 30, 0.5 * kMeasuredConfidence));
  const BoxForm after = FormOfBoxes(tracks_, camera_);
  EXPECT_EQ(after.sd, before.sd);
  EXPECT_EQ(after.log_diagonal, before.log_diagonal);
}

TEST_F(FormOfBoxesTest, OneBoxOfEachSaysNothing) {
  tracks_.tracklets = {{1, {Seen(1, 30, 10)}}, {2, {Seen(1, 10, 10)}}};
  EXPECT_EQ(FormOfBoxes(tracks_, camera_).sd, 1);
  EXPECT_EQ(FormOfBoxes({}, camera_).sd, 1);
}

}  // namespace
}  // namespace flocklift
