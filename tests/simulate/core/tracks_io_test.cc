// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "simulate/core/io.h"
#include "simulate/core/rng.h"
#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

Tracks Parse(const std::string& text) {
  std::istringstream stream(text);
  return ReadTracks(stream, "FILE");
}

std::vector<DetectionFrame> ParseDetections(const std::string& text) {
  std::istringstream stream(text);
  return ReadDetections(stream, "FILE");
}

// Tracks with gaps, of `animals` over `frames`.
Tracks RandomTracks(int animals, int frames) {
  Tracks tracks{.fps = 30000.0 / 1001, .tracklets = {}};
  for (int animal = 0; animal < animals; ++animal) {
    Rng rng(5, static_cast<std::uint64_t>(animal));
    Tracklet tracklet{.id = 1 + animal * animal, .detections = {}};
    for (int frame = 1; frame <= frames; ++frame) {
      if (rng.Below(4) == 0) continue;
      Detection detection;
      detection.frame = frame;
      detection.box = {rng.Uniform(-50, 4000), rng.Uniform(0, 2000), rng.Uniform(1, 80),
                       rng.Uniform(1, 80)};
      detection.confidence = rng.Below(2) == 0 ? 1 : 0.25;
      tracklet.detections.push_back(detection);
    }
    tracks.tracklets.push_back(tracklet);
  }
  return tracks;
}

void ExpectSame(const Tracks& a, const Tracks& b, double tolerance) {
  EXPECT_EQ(a.fps, b.fps);
  ASSERT_EQ(a.tracklets.size(), b.tracklets.size());
  for (std::size_t k = 0; k < a.tracklets.size(); ++k) {
    EXPECT_EQ(a.tracklets[k].id, b.tracklets[k].id);
    const auto& as = a.tracklets[k].detections;
    const auto& bs = b.tracklets[k].detections;
    ASSERT_EQ(as.size(), bs.size());
    for (std::size_t n = 0; n < as.size(); ++n) {
      EXPECT_EQ(as[n].frame, bs[n].frame);
      EXPECT_NEAR(as[n].box.left, bs[n].box.left, tolerance);
      EXPECT_NEAR(as[n].box.top, bs[n].box.top, tolerance);
      EXPECT_NEAR(as[n].box.width, bs[n].box.width, tolerance);
      EXPECT_NEAR(as[n].box.height, bs[n].box.height, tolerance);
      EXPECT_EQ(as[n].confidence, bs[n].confidence);
    }
  }
}

TEST(Tracks, AreReadAsWritten) {
  const Tracks tracks = Parse("1,2,10,20,4,6,0.5,-1,-1,-1\n2,2,11.5,20,4,6,1,-1,-1,-1\n");
  EXPECT_EQ(tracks.fps, std::nullopt);
  ASSERT_EQ(tracks.tracklets.size(), 1u);
  EXPECT_EQ(tracks.tracklets[0].id, 2);
  ASSERT_EQ(tracks.tracklets[0].detections.size(), 2u);
  const Detection& detection = tracks.tracklets[0].detections[0];
  EXPECT_EQ(detection.frame, 1);
  EXPECT_EQ(detection.box.Center(), (Vec2d{12, 23}));
  EXPECT_EQ(detection.confidence, 0.5);
}

TEST(Tracks, MayBeUntidy) {
  const Tracks tidy = Parse("# fps=12.5\n1,1,1,1,2,2\n1,9,3,3,2,2\n2,1,2,2,2,2\n");
  EXPECT_EQ(tidy.fps, 12.5);
  EXPECT_EQ(tidy.tracklets[0].detections[0].confidence, 1);
  const std::vector<std::string> untidy{
      "\xEF\xBB\xBF#fps = 25/2\r\n\r\n2, 1, 2, 2, 2, 2\r\n 1, 9, 3, 3, 2, 2\r\n\t\r\n1,1,1,1,2,2",
      "# fps=12.5\n1.0,1.0,1e0,+1,2,2,1\n1,9,3,3,2,2,1,what,,ever\n# a comment\n2,1,2,2,2,2,1\n",
  };
  for (const std::string& text : untidy) ExpectSame(Parse(text), tidy, 0);
}

TEST(Tracks, SurviveAFile) {
  const TemporaryFolder folder;
  const Tracks tracks = RandomTracks(20, 100);
  for (const char* name : {"tracks.csv", "tracks.h5"}) {
    WriteTracks(folder / name, tracks);
    const Tracks read = ReadTracks(folder / name);
    ExpectSame(read, tracks, 0.51e-4);
    WriteTracks(folder / "again.csv", read);
    EXPECT_EQ(Contents(folder / "again.csv"), Contents(folder / "tracks.csv"));
  }
}

TEST(Tracks, AreWrittenByFrame) {
  const TemporaryFolder folder;
  WriteTracks(folder / "tracks.csv", Parse("2,1,1,1,2,2\n1,3,1,1,2,2\n2,3,0,0,2,2\n"));
  EXPECT_EQ(Contents(folder / "tracks.csv"),
            "1,3,1.0000,1.0000,2.0000,2.0000,1.0000,-1,-1,-1\n"
            "2,1,1.0000,1.0000,2.0000,2.0000,1.0000,-1,-1,-1\n"
            "2,3,0.0000,0.0000,2.0000,2.0000,1.0000,-1,-1,-1\n");
}

TEST(Tracks, OfTheTruthSayThatAllIsVisible) {
  const TemporaryFolder folder;
  WriteTrueTracks(folder / "tracks.csv", Parse("1,3,1,1,2,2\n"));
  EXPECT_EQ(Contents(folder / "tracks.csv"), "1,3,1.0000,1.0000,2.0000,2.0000,1.0000,-1,1,-1\n");
  EXPECT_EQ(ReadTracks(folder / "tracks.csv").tracklets[0].id, 3);
}

TEST(Tracks, OfTheTruthSayWhatObstaclesHide) {
  const TemporaryFolder folder;
  Tracks tracks = Parse("1,3,1,1,2,2\n");
  tracks.tracklets[0].detections[0].visibility = 0.25;
  WriteTrueTracks(folder / "tracks.csv", tracks);
  EXPECT_EQ(Contents(folder / "tracks.csv"), "1,3,1.0000,1.0000,2.0000,2.0000,1.0000,-1,0.25,-1\n");
  EXPECT_EQ(ReadTracks(folder / "tracks.csv").tracklets[0].id, 3);
}

TEST(Tracks, TinyBoxesStayPositive) {
  const TemporaryFolder folder;
  WriteTracks(folder / "tracks.csv", Parse("1,1,1,1,1e-7,1e-7\n"));
  EXPECT_GT(ReadTracks(folder / "tracks.csv").tracklets[0].detections[0].box.width, 0);
}

TEST(Tracks, FaultsAreTold) {
  const std::vector<Fault> faults{
      {"", 0, "no rows"},
      {"# fps=30\n\n", 0, "no rows"},
      {"# fps=fast\n1,1,1,1,2,2\n", 1, "fps is `fast`"},
      {"# fps=0\n", 1, "fps is `0`"},
      {"1,1,1,1,2\n", 1, "5 fields"},
      {"1;1;1;1;2;2\n", 1, "1 fields"},
      {"frame,id,left,top,width,height,confidence\n1,1,1,1,2,2,1\n", 1, "header line; take it out"},
      {"1,1,1,1,2,2\n2,1,1,1,2\n", 2, "fewer"},
      {"1,1,1,1,2,2\n2,1,1,1,2,2,1\n", 2, "more"},
      {"1,1,1,1,2,2\n\n2,1,nan,1,2,2\n", 3, "left is `nan`"},
      {"1,1,1,inf,2,2\n", 1, "top is `inf`"},
      {"1,1,1,2e9,2,2\n", 1, "top is 2000000000"},
      {"1,1,1,,2,2\n", 1, "top is empty"},
      {"1,1,1,1,two,2\n", 1, "width is `two`"},
      {"1.5,1,1,1,2,2\n", 1, "frame is `1.5`"},
      {"0,1,1,1,2,2\n", 1, "frame 0 is below 1"},
      {"-3,1,1,1,2,2\n", 1, "frame -3 is below 1"},
      {"200000000,1,1,1,2,2\n", 1, "frame 200000000 is above"},
      {"1,0,1,1,2,2\n", 1, "id 0 is not positive"},
      {"1,-5,1,1,2,2\n", 1, "id -5 is not positive"},
      {"1,-1,1,1,2,2\n", 1, "belongs to no animal"},
      {"1,x,1,1,2,2\n", 1, "id is `x`"},
      {"1,9223372036854775808,1,1,2,2\n", 1, "id is"},
      {"1,1,1,1,0,2\n", 1, "box is 0 by 2"},
      {"1,1,1,1,2,-2\n", 1, "box is 2 by -2"},
      {"1,1,1,1,2,2,1.01\n", 1, "confidence is 1.01"},
      {"1,1,1,1,2,2,-0.1\n", 1, "confidence is -0.1"},
      {"1,1,1,1,2,2\n2,1,1,1,2,2\n1,1,3,3,2,2\n", 3, "frame 1 of id 1 stands in line 1 already"},
      {"2,1,1,1,2,2\n1,2,1,1,2,2\n1,2,3,3,2,2\n2,1,3,3,2,2", 3, "frame 1 of id 2"},
      {"1,1,1,1,2,2\r\n2,1,1,\r,2,2\r\n", 2, "top is `?`"},
      {std::string("1,1,1,1,2,2\n2,1,\0,1,2,2\n", 24), 2, "left is"},
  };
  for (const Fault& fault : faults) ExpectFault(fault, Parse);
}

TEST(Detections, AreGroupedByFrame) {
  const auto frames =
      ParseDetections("4,-1,1,1,2,2,0.5\n2,-1,5,5,2,2,1\n4,-1,3,3,2,2,1\n4,7,9,9,1,1,1\n");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].frame, 2);
  EXPECT_EQ(frames[1].frame, 4);
  ASSERT_EQ(frames[1].detections.size(), 3u);
  EXPECT_EQ(frames[1].detections[0].box.left, 1);
  EXPECT_EQ(frames[1].detections[0].confidence, 0.5);
  EXPECT_EQ(frames[1].detections[1].box.left, 3);
}

TEST(Detections, SurviveAFile) {
  const TemporaryFolder folder;
  const auto frames = ParseDetections("2,-1,5,5,2,2,1\n4,-1,1,1,2,2,0.5\n4,-1,3,3,2,2,1\n");
  for (const char* name : {"detections.csv", "detections.h5"}) {
    WriteDetections(folder / name, frames);
    const auto read = ReadDetections(folder / name);
    ASSERT_EQ(read.size(), 2u);
    ASSERT_EQ(read[1].detections.size(), 2u);
    EXPECT_EQ(read[1].detections[1].box.left, 3);
    EXPECT_THROW(ReadTracks(folder / name), InputError);
  }
}

TEST(Detections, FaultsAreTold) {
  const std::vector<Fault> faults{
      {"", 0, "no rows"},
      {"1,0,1,1,2,2\n", 1, "use ids from 1, or -1 for none"},
      {"1,-1,1,1,2,2\n1,-2,1,1,2,2\n", 2, "id -2"},
      {"1,-1,1,1,0,2\n", 1, "box is 0 by 2"},
  };
  for (const Fault& fault : faults) ExpectFault(fault, ParseDetections);
}

TEST(ForEachTrackRow, GivesRowsInTheOrderOfTheFile) {
  std::istringstream stream("# fps=24\n3,1,1,1,2,2\n1,-1,2,1,2,2\n");
  std::vector<Id> ids;
  std::vector<double> lefts;
  const auto fps = ForEachTrackRow(stream, "FILE", [&](const TrackRow& row) {
    ids.push_back(row.id);
    lefts.push_back(row.detection.box.left);
  });
  EXPECT_EQ(fps, 24.0);
  EXPECT_EQ(ids, (std::vector<Id>{1, -1}));
  EXPECT_EQ(lefts, (std::vector<double>{1, 2}));
}

TEST(Files, ThatAreNotThereAreTold) {
  const TemporaryFolder folder;
  for (const char* name : {"no.csv", "no.h5"}) {
    try {
      ReadTracks(folder / name);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()),
                (folder / name).string() + ": there is no such file; check the name");
    }
  }
  EXPECT_THROW(ReadTracks(folder.path()), InputError);
}

TEST(TrackWriter, WithoutCommitLeavesTheOldFile) {
  const TemporaryFolder folder;
  for (const char* name : {"tracks.csv", "tracks.h5"}) {
    WriteTracks(folder / name, RandomTracks(2, 3));
    const std::string before = Contents(folder / name);
    {
      TrackWriter writer(folder / name, 25.0);
      writer.Add(1, {.frame = 1, .box = {1, 1, 1, 1}, .confidence = 1, .shape = {}});
    }
    EXPECT_EQ(Contents(folder / name), before);
  }
}

}  // namespace
}  // namespace flocklift
