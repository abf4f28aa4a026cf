// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A small file in each layout, as the programs' documentation describes them: two animals, the
// first at (10, 20), (13, 21), the second at (50, 60) in the second frame only.

#include "track/interchange/foreign_tracks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

ForeignTracks Read(const std::string& text, const ForeignOptions& options = {}) {
  std::istringstream stream(text);
  return ReadForeignTracks(stream, "FILE", options);
}

void ExpectTheTwo(const Tracks& tracks) {
  ASSERT_EQ(tracks.tracklets.size(), 2u);
  const Tracklet &a = tracks.tracklets[0], &b = tracks.tracklets[1];
  EXPECT_EQ(a.id, 1);
  EXPECT_EQ(b.id, 2);
  ASSERT_EQ(a.detections.size(), 2u);
  ASSERT_EQ(b.detections.size(), 1u);
  EXPECT_EQ(a.detections[0].frame, 1);
  EXPECT_EQ(a.detections[1].frame, 2);
  EXPECT_EQ(b.detections[0].frame, 2);
  EXPECT_NEAR(a.detections[0].box.Center().x, 10, 1e-9);
  EXPECT_NEAR(a.detections[0].box.Center().y, 20, 1e-9);
  EXPECT_NEAR(a.detections[1].box.Center().x, 13, 1e-9);
  EXPECT_NEAR(a.detections[1].box.Center().y, 21, 1e-9);
  EXPECT_NEAR(b.detections[0].box.Center().x, 50, 1e-9);
  EXPECT_NEAR(b.detections[0].box.Center().y, 60, 1e-9);
}

TEST(ForeignTracksTest, MotChallenge) {
  const ForeignTracks read = Read(
      "1,1,6,17,8,6,0.9,-1,-1,-1\n"
      "2,1,9,18,8,6,0.8,-1,-1,-1\n"
      "2,2,46,57,8,6,35.5,-1,-1,-1\n"
      "2,3,1,1,8,6,0,-1,-1,-1\n");  // to be ignored
  EXPECT_EQ(read.layout, "MOTChallenge");
  EXPECT_TRUE(read.has_boxes);
  ExpectTheTwo(read.tracks);
  EXPECT_EQ(read.tracks.tracklets[0].detections[0].box.width, 8);
  EXPECT_EQ(read.tracks.tracklets[0].detections[0].confidence, 0.9);
  EXPECT_EQ(read.tracks.tracklets[1].detections[0].confidence, 1);
}

TEST(ForeignTracksTest, MotChallengeWithNames) {
  const ForeignTracks read = Read(
      "frame,id,bb_left,bb_top,bb_width,bb_height,conf,x,y,z\n"
      "1,1,6,17,8,6,1,-1,-1,-1\n2,1,9,18,8,6,1,-1,-1,-1\n2,2,46,57,8,6,1,-1,-1,-1\n");
  EXPECT_EQ(read.layout, "MOTChallenge");
  ExpectTheTwo(read.tracks);
}

TEST(ForeignTracksTest, MotChallengeDetections) {
  const ForeignTracks read = Read("2,-1,9,18,8,6,0.8\n1,-1,6,17,8,6,0.9\n2,-1,46,57,8,6,0.3\n");
  EXPECT_FALSE(read.has_ids);
  ASSERT_EQ(read.detections.size(), 2u);
  EXPECT_EQ(read.detections[0].frame, 1);
  EXPECT_EQ(read.detections[0].detections.size(), 1u);
  EXPECT_EQ(read.detections[1].detections.size(), 2u);
}

TEST(ForeignTracksTest, Trackpy) {
  // An unnamed index first; rows that were not linked have no particle.
  const ForeignTracks read = Read(
      ",y,x,mass,size,ecc,signal,raw_mass,ep,frame,particle\n"
      "0,20.0,10.0,431.5,2.0,0.1,20.1,900.0,0.05,0,0.0\n"
      "3,21.0,13.0,433.1,2.0,0.1,20.3,901.0,0.05,1,0.0\n"
      "4,60.0,50.0,440.0,2.0,0.2,20.9,905.0,0.05,1,1.0\n"
      "5,61.0,90.0,440.0,2.0,0.2,20.9,905.0,0.05,1,\n");
  EXPECT_EQ(read.layout, "trackpy");
  EXPECT_TRUE(read.has_boxes);
  ExpectTheTwo(read.tracks);
  // Radius of gyration 2 of a disc-like Gaussian: 4 standard deviations of sqrt(2) each.
  EXPECT_NEAR(read.tracks.tracklets[0].detections[0].box.width, 4 * std::sqrt(2.0), 1e-9);
}

TEST(ForeignTracksTest, TrackpyBeforeLinking) {
  const ForeignTracks read = Read("y,x,mass,frame\n20,10,431.5,0\n21,13,433.1,1\n");
  EXPECT_EQ(read.layout, "trackpy");
  EXPECT_FALSE(read.has_ids);
  EXPECT_FALSE(read.has_boxes);
  ASSERT_EQ(read.detections.size(), 2u);
  EXPECT_EQ(read.detections[0].detections[0].box.Center(), (Vec2d{10, 20}));
}

TEST(ForeignTracksTest, IdtrackerAi) {
  const ForeignTracks read = Read(
      "time,x1,y1,x2,y2\n"
      "0.000,10.0,20.0,nan,nan\n"
      "0.040,13.0,21.0,50.0,60.0\n");
  EXPECT_EQ(read.layout, "idtracker.ai");
  EXPECT_FALSE(read.has_boxes);
  EXPECT_EQ(read.tracks.fps, 25);
  ExpectTheTwo(read.tracks);
}

TEST(ForeignTracksTest, IdtrackerAiTidy) {
  const ForeignTracks read = Read(
      "frame,time,individual,x,y,probability\n"
      "0,0.0,0,10.0,20.0,0.98\n0,0.0,1,nan,nan,nan\n"
      "1,0.02,0,13.0,21.0,0.1\n1,0.02,1,50.0,60.0,1.0\n");
  EXPECT_EQ(read.layout, "idtracker.ai");
  EXPECT_EQ(read.tracks.fps, 50);
  ExpectTheTwo(read.tracks);
  // An uncertain identity was seen all the same.
  EXPECT_GE(read.tracks.tracklets[0].detections[1].confidence, kMeasuredConfidence);
  EXPECT_LT(read.tracks.tracklets[0].detections[1].confidence, 0.6);
}

TEST(ForeignTracksTest, DltDv) {
  // Pixels count from 1; the second camera is not ours.
  const std::string text =
      "pt1_cam1_X,pt1_cam1_Y,pt1_cam2_X,pt1_cam2_Y,pt2_cam1_X,pt2_cam1_Y,pt2_cam2_X,pt2_cam2_Y\n"
      "11,21,5,5,NaN,NaN,NaN,NaN\n14,22,6,6,51,61,NaN,NaN\n";
  const ForeignTracks read = Read(text);
  EXPECT_EQ(read.layout, "DLTdv");
  ExpectTheTwo(read.tracks);
  const ForeignTracks other = Read(text, {.camera = 2});
  ASSERT_EQ(other.tracks.tracklets.size(), 1u);
  EXPECT_EQ(other.tracks.tracklets[0].detections[1].box.Center(), (Vec2d{5, 5}));
  EXPECT_THROW(Read(text, {.camera = 3}), InputError);
}

TEST(ForeignTracksTest, OlderDltDvCountsFromTheBottom) {
  const ForeignTracks read = Read("pt1_cam1_X,pt1_cam1_Y\n11,1\n11,100\n", {.up_height = 100});
  EXPECT_EQ(read.tracks.tracklets[0].detections[0].box.Center(), (Vec2d{10, 99}));
  EXPECT_EQ(read.tracks.tracklets[0].detections[1].box.Center(), (Vec2d{10, 0}));
}

TEST(ForeignTracksTest, TrexWritesAFileAnAnimal) {
  const fs::path folder = fs::path(testing::TempDir()) / "foreign_tracks_trex";
  fs::create_directories(folder);
  const std::string names =
      "frame,time,X (cm),X#wcentroid (cm),Y (cm),Y#wcentroid (cm),"
      "SPEED (cm/s),num_pixels,missing\n";
  std::ofstream(folder / "film_fish0.csv")
      << names << "0,0.0,1.1,1.0,2.1,2.0,0.1,78.5398,0\n1,0.04,1.4,1.3,2.2,2.1,0.1,78.5398,0\n";
  std::ofstream(folder / "film_fish1.csv")
      << names << "0,0.0,inf,inf,inf,inf,inf,inf,1\n1,0.04,5.1,5.0,6.1,6.0,0.1,78.5398,0\n";
  const ForeignTracks read = ReadForeignTracks(folder, {.scale = 10});
  fs::remove_all(folder);
  EXPECT_EQ(read.layout, "TRex");
  EXPECT_EQ(read.tracks.fps, 25);
  ExpectTheTwo(read.tracks);
}

TEST(ForeignTracksTest, SemicolonsTabsAndQuotesAreTaken) {
  ExpectTheTwo(
      Read("\"time\";\"x1\";\"y1\";\"x2\";\"y2\"\r\n0;10;20;;\r\n1;13;21;50;60\r\n").tracks);
  ExpectTheTwo(Read("1\t1\t6\t17\t8\t6\n2\t1\t9\t18\t8\t6\n2\t2\t46\t57\t8\t6\n").tracks);
}

TEST(ForeignTracksTest, ASessionFolderOfIdtrackerAi) {
  const fs::path folder = fs::path(testing::TempDir()) / "foreign_tracks_session";
  fs::create_directories(folder / "trajectories" / "trajectories_csv");
  std::ofstream(folder / "trajectories" / "trajectories_csv" / "trajectories.csv")
      << "time,x1,y1,x2,y2\n0,10,20,nan,nan\n0.1,13,21,50,60\n";
  std::ofstream(folder / "trajectories" / "trajectories_csv" / "areas.csv") << "mean,sd\n1,2\n";
  ExpectTheTwo(ReadForeignTracks(folder, {}).tracks);
  fs::remove_all(folder);
}

class ForeignTracksRefuse : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(ForeignTracksRefuse, WithTheReason) {
  const auto [text, fault] = GetParam();
  try {
    Read(text);
    FAIL() << text;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("FILE"));
    EXPECT_THAT(error.what(), testing::HasSubstr(fault));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Faults, ForeignTracksRefuse,
    testing::Values(std::pair{"", "the file is empty"},
                    std::pair{"a,b,c\n1,2,3\n", "the columns are `a,b,c`; give one of MOT"},
                    std::pair{"1,2,3\n", "no names and 3 columns"},
                    std::pair{"x,y,frame,particle\n1,2,zero,1\n", "FILE:2: column `frame`"},
                    std::pair{"x,y,frame,particle\n1,2,0\n", "FILE:2: the row has 3 fields"},
                    std::pair{"x,y,frame,particle\n1,2,0,1\n1,2,0,1\n", "stands twice in frame 1"},
                    std::pair{"x,y,frame,particle\n1,2,-3,1\n", "FILE:2: the frame is no whole"},
                    std::pair{"x,y,frame,particle\n1,2,0,0.5\n", "FILE:2: the id is no positive"},
                    std::pair{"x,y,frame,particle\n1e12,2,0,1\n", "beyond any picture"},
                    std::pair{"time,x1,y1\n0,nan,nan\n", "no animal is in any row"},
                    std::pair{"1,1,5,5,0,8\n", "FILE:1: the box has no size"},
                    std::pair{"1,1,nan,5,8,8\n", "FILE:1: field 3 is missing"},
                    std::pair{"1,1,5,5,8,8\n1,-1,5,5,8,8\n", "some rows have an id"}));

}  // namespace
}  // namespace flocklift
