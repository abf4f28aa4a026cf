// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/table_by_frame.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "simulate/core/rng.h"
#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

class TableByFrameTest : public testing::Test {
 protected:
  std::filesystem::path Path(const std::string& name) const { return folder_ / ("table" + name); }
  std::filesystem::path Write(const std::string& text, const std::string& name = ".csv") const {
    std::ofstream(Path(name), std::ios::binary) << text;
    return Path(name);
  }

 private:
  TemporaryFolder folder_;
};

// Many blocks of text, with gaps in every path and frames that nobody is in.
Trajectories Flock() {
  Trajectories flock{.fps = 50, .has_velocity = true, .trajectories = {}};
  for (Id id = 1; id <= 60; ++id) {
    Rng rng(5, static_cast<std::uint64_t>(id));
    Trajectory t{.id = 7 * id, .points = {}};
    for (int frame = 4; frame < 400; ++frame) {
      if (rng.Below(4) == 0 || (frame > 100 && frame < 130)) continue;
      t.points.push_back({.frame = frame,
                          .position = {rng.Normal(), rng.Normal(), rng.Normal()},
                          .velocity = {rng.Normal(), rng.Normal(), rng.Normal()},
                          .world_from_body = {}});
    }
    flock.trajectories.push_back(std::move(t));
  }
  return flock;
}

Tracks Boxes(const Trajectories& flock) {
  Tracks tracks{.fps = flock.fps, .tracklets = {}};
  for (const Trajectory& t : flock.trajectories) {
    Tracklet tracklet{t.id, {}};
    for (const TrajectoryPoint& p : t.points) {
      Detection d;
      d.frame = p.frame;
      d.box = Box::Around({100 + p.position.x, 100 + p.position.y}, 8, 6);
      tracklet.detections.push_back(d);
    }
    tracks.tracklets.push_back(std::move(tracklet));
  }
  return tracks;
}

// What a whole file says of some frames, as text.
std::string Of(const Trajectories& flock, int first, int last) {
  std::string text;
  for (const Trajectory& t : flock.trajectories) {
    for (const TrajectoryPoint& p : t.points) {
      if (p.frame < first || p.frame > last) continue;
      text += std::to_string(p.frame) + ' ' + std::to_string(t.id) + ' ' +
              std::to_string(p.position.x) + ' ' + std::to_string(p.velocity.z) + '\n';
    }
  }
  return text;
}
std::string Of(const Tracks& tracks, int first, int last) {
  std::string text;
  for (const Tracklet& t : tracks.tracklets) {
    for (const Detection& d : t.detections) {
      if (d.frame < first || d.frame > last) continue;
      text += std::to_string(d.frame) + ' ' + std::to_string(t.id) + ' ' +
              std::to_string(d.box.left) + '\n';
    }
  }
  return text;
}

TEST_F(TableByFrameTest, WindowsAreTheRowsOfTheWholeFile) {
  for (const char* suffix : {".csv", ".h5"}) {
    WriteTrajectories(Path(suffix), Flock());
    const Trajectories whole = ReadTrajectories(Path(suffix));
    const auto table = TableByFrame::Open(Path(suffix), "trajectories");
    ASSERT_TRUE(table.has_value());
    const FrameSpan span = SpanOf(whole);
    EXPECT_EQ(table->first_frame(), span.first);
    EXPECT_EQ(table->last_frame(), span.last);
    for (int first = -3; first < 420; first += 17) {
      for (const int length : {0, 1, 40}) {
        const auto window = ReadTrajectories(*table, first, first + length - 1);
        ASSERT_TRUE(window.has_value());
        EXPECT_EQ(Of(*window, -100, 1000), Of(whole, first, first + length - 1));
      }
    }
    const auto some = ReadTrajectories(*table, 10, 12);
    EXPECT_EQ(some->fps, whole.fps);
    EXPECT_TRUE(some->has_velocity);
    EXPECT_FALSE(some->has_orientation);
    EXPECT_EQ(ReadTrajectories(*table, 0, 0)->fps, whole.fps);
  }
}

TEST_F(TableByFrameTest, TracksHaveNoHeader) {
  for (const char* suffix : {".csv", ".h5"}) {
    WriteTracks(Path(suffix), Boxes(Flock()));
    const Tracks whole = ReadTracks(Path(suffix));
    const auto table = TableByFrame::Open(Path(suffix), "tracks");
    ASSERT_TRUE(table.has_value());
    for (int first = 1; first < 400; first += 33) {
      EXPECT_EQ(Of(*ReadTracks(*table, first, first + 9), -100, 1000), Of(whole, first, first + 9));
    }
    EXPECT_EQ(ReadTracks(*table, 10, 12)->fps, whole.fps);
  }
}

TEST_F(TableByFrameTest, EveryFrameOfEveryShortFile) {
  // Frames of one row each, with gaps: every place where halving may end.
  for (int rows = 1; rows < 12; ++rows) {
    std::string text = "# made by hand\nframe,id,x,y,z\n";
    for (int k = 0; k < rows; ++k) text += std::to_string(2 + 3 * k * k) + ",1,0,0,0\n";
    for (const bool has_end : {true, false}) {
      if (!has_end) text.pop_back();
      const auto table = TableByFrame::Open(Write(text), "trajectories");
      ASSERT_TRUE(table.has_value());
      EXPECT_EQ(table->first_frame(), 2);
      EXPECT_EQ(table->last_frame(), 2 + 3 * (rows - 1) * (rows - 1));
      for (int frame = 1; frame < 400; ++frame) {
        const auto found = ReadTrajectories(*table, frame, frame);
        ASSERT_TRUE(found.has_value());
        bool is_there = false;
        for (int k = 0; k < rows; ++k) is_there = is_there || frame == 2 + 3 * k * k;
        EXPECT_EQ(!found->trajectories.empty(), is_there) << frame << " of " << rows;
      }
    }
  }
}

TEST_F(TableByFrameTest, TakesWhatPeopleWrite) {
  const auto table = TableByFrame::Open(
      Write("\xEF\xBB\xBF# fps=25\r\n\r\n\"frame\",\"x\",\"y\",\"z\",\"id\"\r\n 2 ,1,2,3,5\r\n"
            "# between\r\n2,4,5,6,1\r\n\r\n4,7,8,9,9999999999"),
      "trajectories");
  ASSERT_TRUE(table.has_value());
  EXPECT_EQ(table->first_frame(), 2);
  EXPECT_EQ(table->last_frame(), 4);
  EXPECT_TRUE(ReadTrajectories(*table, 3, 3)->trajectories.empty());
  EXPECT_EQ(ReadTrajectories(*table, 4, 4)->trajectories.at(0).points.at(0).position.z, 9);
  EXPECT_EQ(ReadTrajectories(*table, 4, 4)->trajectories.at(0).id, 9999999999);
  EXPECT_EQ(ReadTrajectories(*table, 2, 2)->trajectories.size(), 2u);
  EXPECT_EQ(ReadTrajectories(*table, 2, 2)->fps, 25);
}

TEST_F(TableByFrameTest, LeavesOtherFilesAlone) {
  const std::string head = "frame,id,x,y,z\n";
  for (const std::string& text : {
           head + "2,1,0,0,0\n1,1,0,0,0\n",             // not by frame
           head + "0,1,0,0,0\n",                        // no frame
           head,                                        // no rows
           std::string("id,frame,x,y,z\n1,1,0,0,0\n"),  // another order
           std::string(),
       }) {
    EXPECT_FALSE(TableByFrame::Open(Write(text), "trajectories").has_value()) << text;
  }
  EXPECT_THROW(TableByFrame::Open(Path(".none"), "tracks"), InputError);
}

TEST_F(TableByFrameTest, SaysThatRowsDoNotStandByFrameWhenItComesAcrossThem) {
  std::string text = "frame,id,x,y,z\n";
  for (int frame = 1; frame <= 5000; ++frame) {
    // Two rows that were exchanged, where no probe looks.
    const int f = frame == 3001 ? 3002 : frame == 3002 ? 3001 : frame;
    text += std::to_string(f) + ",1,0,0,0\n";
  }
  const auto table = TableByFrame::Open(Write(text), "trajectories");
  ASSERT_TRUE(table.has_value());
  EXPECT_TRUE(ReadTrajectories(*table, 1, 2900).has_value());
  bool is_by_frame = true;
  for (int first = 2990; first < 3010; first += 2) {
    is_by_frame = is_by_frame && ReadTrajectories(*table, first, first + 1).has_value();
  }
  EXPECT_FALSE(is_by_frame);
}

TEST_F(TableByFrameTest, DamagedRowsAreToldByFileAndLine) {
  std::string text = "# fps=25\nframe,id,x,y,z\n";
  constexpr int kBad = 700, kTwice = 900;  // of 1000 frames
  for (int frame = 1; frame <= 1000; ++frame) {
    text += std::to_string(frame) + ",1," + (frame == kBad ? "zero" : "0") + ",0,0\n";
    text += std::to_string(frame) + (frame == kTwice ? ",1,0,0,0\n" : ",2,0,0,0\n");
  }
  const auto path = Write(text);
  const auto table = TableByFrame::Open(path, "trajectories");
  ASSERT_TRUE(table.has_value());
  EXPECT_EQ(ReadTrajectories(*table, 1, kBad - 1)->trajectories.size(), 2u);
  EXPECT_EQ(ReadTrajectories(*table, kBad + 1, kTwice - 1)->trajectories.size(), 2u);
  const auto fault_of = [](const auto& read) {
    try {
      read();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  // The line of the file, as when the whole is read.
  const std::string whole = fault_of([&] { ReadTrajectories(path); });
  EXPECT_NE(whole.find(":1401: x is `zero`"), std::string::npos) << whole;
  EXPECT_EQ(fault_of([&] { ReadTrajectories(*table, 690, 710); }), whole);
  const std::string twice = fault_of([&] { ReadTrajectories(*table, kTwice - 5, kTwice + 5); });
  EXPECT_NE(twice.find(":1802: frame 900 of id 1 stands in line 1801 already"), std::string::npos)
      << twice;
}

TEST_F(TableByFrameTest, FindsFramesBesideADamagedStretch) {
  std::string text;
  for (int frame = 1; frame <= 4000; ++frame) {
    const bool is_lost = frame >= 1500 && frame < 1700;
    text += is_lost ? std::string("\x01\x02 lost, 3\n") : std::to_string(frame) + ",1,0,0,9,9,1\n";
  }
  const auto table = TableByFrame::Open(Write(text), "tracks");
  ASSERT_TRUE(table.has_value());
  EXPECT_EQ(table->last_frame(), 4000);
  for (int first = 1; first <= 4000; first += 50) {
    if (first + 49 < 1499 || first >= 1700) {
      EXPECT_EQ(ReadTracks(*table, first, first + 49)->tracklets.at(0).detections.size(), 50u);
    }
  }
  EXPECT_THROW(ReadTracks(*table, 1450, 1720), InputError);
  EXPECT_THROW(ReadTracks(*table, 1450, 1499), InputError);  // what follows its rows is lost
}

TEST_F(TableByFrameTest, DamagedRowsOfHdf5AreToldByRow) {
  Trajectories flock = Flock();
  flock.has_sd_depth = true;
  flock.trajectories.at(3).points.at(200).sd_depth = -1;
  const int frame = flock.trajectories.at(3).points.at(200).frame;
  WriteTrajectories(Path(".h5"), flock);
  const auto table = TableByFrame::Open(Path(".h5"), "trajectories");
  ASSERT_TRUE(table.has_value());
  EXPECT_TRUE(ReadTrajectories(*table, 1, frame - 1).has_value());
  EXPECT_TRUE(ReadTrajectories(*table, frame + 1, 400).has_value());
  std::string whole, part;
  try {
    ReadTrajectories(Path(".h5"));
  } catch (const InputError& error) {
    whole = error.what();
  }
  try {
    ReadTrajectories(*table, frame, frame);
  } catch (const InputError& error) {
    part = error.what();
  }
  EXPECT_NE(whole.find("sd_depth is -1"), std::string::npos) << whole;
  EXPECT_EQ(part, whole);
}

}  // namespace
}  // namespace flocklift
