// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/tracklet_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "simulate/core/io.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

// Tracks that begin anywhere, have gaps, are long and short; some rows have shapes.
Tracks Some() {
  Tracks tracks{.fps = 25, .tracklets = {}};
  for (int id = 1; id <= 20; ++id) {
    Rng rng(3, static_cast<std::uint64_t>(id));
    Tracklet tracklet{3 * id, {}};
    const int first = static_cast<int>(rng.Uniform(1, 200));
    const int last = first + static_cast<int>(rng.Uniform(0, 300));
    for (int frame = first; frame <= last; ++frame) {
      if (frame > first && rng.Uniform(0, 1) < 0.1) continue;
      Detection row;
      row.frame = frame;
      row.box = {rng.Uniform(0, 600), rng.Uniform(0, 400), 8, 6};
      row.confidence = 0.75;
      if (rng.Uniform(0, 1) < 0.5) row.shape = Shape{9, 5, rng.Uniform(0, 180), 40};
      tracklet.detections.push_back(row);
    }
    tracks.tracklets.push_back(std::move(tracklet));
  }
  return tracks;
}

std::string TextOf(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

class TrackletFileTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    for (const Tracklet& tracklet : tracks_.tracklets) file_.Add(tracklet);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // The tables that the file gives and those that the tracks give.
  void ExpectSameTables(const Tracks& tracks) {
    WriteTracksAndShapes(folder_ / "t.csv", folder_ / "s.csv", tracks.fps, file_);
    WriteTracks(folder_ / "wanted_t.csv", tracks);
    WriteShapes(folder_ / "wanted_s.csv", tracks);
    EXPECT_EQ(TextOf(folder_ / "t.csv"), TextOf(folder_ / "wanted_t.csv"));
    EXPECT_EQ(TextOf(folder_ / "s.csv"), TextOf(folder_ / "wanted_s.csv"));
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / "tracklet_file_test";
  const Tracks tracks_ = Some();
  TrackletFile file_{folder_};
};

TEST_F(TrackletFileTest, WritesTheTablesThatTheTracksInMemoryWrite) {
  EXPECT_EQ(file_.size(), tracks_.tracklets.size());
  ExpectSameTables(tracks_);
}

TEST_F(TrackletFileTest, GivesTheRowsOfSomeFrames) {
  for (const auto& [first, last] : {std::pair(1, 500), {50, 60}, {200, 200}, {-5, 0}, {499, 900}}) {
    const Tracks some = file_.Between(first, last);
    std::size_t next = 0;
    for (const Tracklet& whole : tracks_.tracklets) {
      std::vector<int> wanted;
      for (const Detection& d : whole.detections) {
        if (d.frame >= first && d.frame <= last) wanted.push_back(d.frame);
      }
      if (wanted.empty()) continue;
      ASSERT_LT(next, some.tracklets.size());
      const Tracklet& found = some.tracklets[next++];
      EXPECT_EQ(found.id, whole.id);
      ASSERT_EQ(found.detections.size(), wanted.size());
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        EXPECT_EQ(found.detections[k].frame, wanted[k]);
      }
    }
    EXPECT_EQ(next, some.tracklets.size());
  }
}

TEST_F(TrackletFileTest, GivesAllAndBeginsAnew) {
  const std::vector<Tracklet> all = file_.All();
  ASSERT_EQ(all.size(), tracks_.tracklets.size());
  EXPECT_EQ(all[4].detections.size(), tracks_.tracklets[4].detections.size());
  file_.Clear();
  EXPECT_EQ(file_.size(), 0u);
  EXPECT_EQ(file_.last_frame(), 0);
  const Tracks one{.fps = 30, .tracklets = {all[7]}};
  file_.Add(all[7]);
  EXPECT_EQ(file_.last_frame(), all[7].detections.back().frame);
  ExpectSameTables(one);
}

TEST_F(TrackletFileTest, NoTracksAreEmptyTables) {
  file_.Clear();
  ExpectSameTables({});
}

}  // namespace
}  // namespace flocklift
