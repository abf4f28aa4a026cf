// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/run_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

#include "simulate/core/io.h"
#include "simulate/core/rng.h"
#include "tests/simulate/core/fault.h"
#include "tools/view/late_reader.h"

namespace flocklift {
namespace {

constexpr int kFrames = 600;
constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

// Some come late and some leave early; each is missed now and then.
Trajectories Flock(bool has_velocity = true) {
  Trajectories flock{
      .fps = 50, .has_velocity = has_velocity, .has_sd_depth = true, .trajectories = {}};
  for (Id id = 1; id <= 12; ++id) {
    Rng rng(8, static_cast<std::uint64_t>(id));
    Trajectory t{.id = id, .points = {}};
    const int first = id == 3 ? 5 : id == 11 ? 400 : 1, last = id == 5 ? 200 : kFrames;
    for (int frame = first; frame <= last; ++frame) {
      if (rng.Below(6) == 0) continue;
      TrajectoryPoint p;
      p.frame = frame;
      p.position = {rng.Normal(), rng.Normal(), 20 + rng.Normal()};
      p.velocity = {rng.Normal(), rng.Normal(), rng.Normal()};
      p.sd_depth = 0.5;
      t.points.push_back(p);
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

// A packed window as lines "frame id column column ..", whatever the animals' places are.
std::string TextOf(const RunData& data, const std::string& what, int first, int last) {
  const std::string bytes = data.Window(what, first, last);
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), 4 * words.size());
  const std::uint32_t frames = words[3], rows = words[4];
  const auto animals = data.Versions().at("animals");
  std::vector<std::string> lines;
  const std::uint32_t* start = words.data() + 8;
  const std::uint32_t* animal = start + frames + 1;
  const float* columns = reinterpret_cast<const float*>(animal + rows);
  const std::uint32_t width = what == "boxes" ? 4 : 3;
  for (std::uint32_t k = 0; k < frames; ++k) {
    for (std::uint32_t r = start[k]; r < start[k + 1]; ++r) {
      std::string line =
          std::to_string(words[2] + k) + ' ' + animals.at(animal[r]).get<std::string>();
      for (std::uint32_t c = 0; c < width; ++c) {
        line += ' ' + std::to_string(columns[width * r + c]);
        if (what != "boxes") line += ' ' + std::to_string(columns[3 * rows + width * r + c]);
      }
      lines.push_back(line);
    }
  }
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

class RunDataTest : public testing::Test {
 protected:
  void Write(const std::string& suffix, const Trajectories& flock) const {
    WriteTrajectories(folder_ / ("trajectories" + suffix), flock);
    WriteTracks(folder_ / ("tracks" + suffix), Boxes(flock));
  }
  void WriteText(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  RunDataOptions Options(std::uint64_t large_bytes) const {
    return {.folder = folder_.path(), .large_bytes = large_bytes};
  }
  // What the reader of the rest tells last.
  nlohmann::ordered_json ReadRest(RunData* data) const {
    std::shared_mutex mutex;
    EventBus bus;
    LateReader(data, &mutex, &bus).Run([](std::int64_t, std::int64_t) {});
    std::string news;
    bus.Subscribe()([&news](std::string_view text) {
      news += text;
      return true;
    });
    const std::size_t at = news.find("data: ", news.find("event: reading")) + 6;
    return nlohmann::ordered_json::parse(news.substr(at, news.find('\n', at) - at));
  }

  TemporaryFolder folder_;
};

TEST_F(RunDataTest, WindowsOfLargeFilesAreThoseOfTheWhole) {
  for (const char* suffix : {".csv", ".h5"}) {
    for (const char* old : {"tracks.csv", "trajectories.csv"}) {
      std::filesystem::remove(folder_ / old);
    }
    Write(suffix, Flock());
    const RunData whole(Options(kNever));
    RunData large(Options(0));
    EXPECT_TRUE(large.track_file().has_value());
    EXPECT_TRUE(large.FlockOf("before")->file().has_value());
    EXPECT_FALSE(whole.track_file().has_value());
    EXPECT_EQ(large.Span().last, whole.Span().last);
    EXPECT_EQ(large.run().fps, whole.run().fps);
    EXPECT_EQ(large.Session().at("has"), whole.Session().at("has"));
    EXPECT_NE(TextOf(whole, "before", 1, 20), "");
    for (const bool is_read : {false, true}) {
      for (int first = -10; first < kFrames + 10; first += 19) {
        for (const char* what : {"boxes", "before", "truth"}) {
          EXPECT_EQ(TextOf(large, what, first, first + 7), TextOf(whole, what, first, first + 7))
              << what << ' ' << first;
        }
      }
      if (!is_read) {
        EXPECT_EQ(ReadRest(&large).dump(), R"({"text":"","faults":[]})");
      }
    }
    EXPECT_EQ(large.animal_count(), whole.animal_count());
    EXPECT_FALSE(large.track_file().has_value());
    EXPECT_EQ(large.Session().at("edits"), whole.Session().at("edits"));
    const Tracks a = AsTracks(large.CurrentTracks()), b = AsTracks(whole.CurrentTracks());
    ASSERT_EQ(a.tracklets.size(), b.tracklets.size());
    for (std::size_t k = 0; k < a.tracklets.size(); ++k) {
      EXPECT_EQ(a.tracklets[k].id, b.tracklets[k].id);
      EXPECT_EQ(a.tracklets[k].detections.size(), b.tracklets[k].detections.size());
    }
  }
}

TEST_F(RunDataTest, CorrectionsAreInForceOnceTheTracksAreRead) {
  Write(".csv", Flock());
  WriteText("corrections.txt", "swap 1 2 300\n");
  const RunData whole(Options(kNever));
  RunData large(Options(0));
  EXPECT_THROW(large.CurrentTracks(), std::invalid_argument);
  EXPECT_THROW(large.editor(), std::invalid_argument);
  EXPECT_NE(TextOf(large, "boxes", 310, 312), TextOf(whole, "boxes", 310, 312));
  const int version = large.Versions().at("boxes").get<int>();
  ReadRest(&large);
  EXPECT_GT(large.Versions().at("boxes").get<int>(), version);
  EXPECT_EQ(TextOf(large, "boxes", 310, 312), TextOf(whole, "boxes", 310, 312));
}

TEST_F(RunDataTest, VelocitiesThatTheFileLacksAreThoseOfTheWhole) {
  // None is missing for more than 8 frames, but before it comes and after it goes.
  Write(".csv", Flock(/*has_velocity=*/false));
  const RunData whole(Options(kNever)), large(Options(0));
  for (int first = 1; first < kFrames; first += 31) {
    EXPECT_EQ(TextOf(large, "before", first, first + 11),
              TextOf(whole, "before", first, first + 11));
  }
}

// The second half of both files has rows that are no numbers.
TEST_F(RunDataTest, SoundFramesAreServedBesideDamagedOnes) {
  Write(".csv", Flock());
  long line = 0, first_bad = 0;
  for (const char* name : {"tracks.csv", "trajectories.csv"}) {
    std::string text;
    std::ifstream file(folder_ / name);
    line = first_bad = 0;
    for (std::string row; std::getline(file, row);) {
      ++line;
      const bool is_bad = row.front() != '#' && row.front() != 'f' && std::stoi(row) > kFrames / 2;
      if (is_bad && first_bad == 0) first_bad = line;
      if (is_bad) row = row.substr(0, row.find_last_of(',')) + ",lost";
      // Of tracks what follows the seven columns is anybody's: the width goes.
      if (is_bad && name == std::string("tracks.csv")) row.replace(row.find(",8.0000"), 7, ",lost");
      text += row + '\n';
    }
    file.close();
    WriteText(name, text);
  }
  RunData data(Options(0));
  EXPECT_EQ(data.Span().last, kFrames);
  EXPECT_NE(data.Session().at("bounds"), nullptr);
  EXPECT_NE(TextOf(data, "before", 290, kFrames / 2), "");
  const auto fault_of = [&](const std::string& what) -> std::string {
    try {
      data.Window(what, kFrames / 2 - 3, kFrames / 2 + 3);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string fault = fault_of("before");
  EXPECT_EQ(fault.find((folder_ / "trajectories.csv").string() + ":" + std::to_string(first_bad) +
                       ": sd_depth is `lost`; "),
            0u)
      << fault;
  const auto told = ReadRest(&data);
  ASSERT_EQ(told.at("faults").size(), 2u) << told;
  EXPECT_EQ(told.at("text"), "");
  EXPECT_EQ(told.at("faults").at(0), fault_of("boxes"));
  EXPECT_EQ(told.at("faults").at(1), fault);
  // What needs all tracks says why it cannot be done; looking goes on.
  EXPECT_EQ(data.Edits().at("reason"), fault_of("boxes"));
  EXPECT_THROW(data.CurrentTracks(), std::invalid_argument);
  EXPECT_NE(TextOf(data, "boxes", 290, kFrames / 2), "");
  EXPECT_NE(TextOf(data, "before", 1, 20), "");
}

TEST_F(RunDataTest, AFileThatIsNotByFrameAfterAllIsReadWhole) {
  Write(".csv", Flock());
  const RunData whole(Options(kNever));
  for (const char* name : {"tracks.csv", "trajectories.csv"}) {
    // A row of frame 450 stands at the end of frame 451, where no probe looks.
    std::string text, moved;
    std::ifstream file(folder_ / name);
    for (std::string row; std::getline(file, row);) {
      if (moved.empty() && row.starts_with("450,")) {
        moved = row + '\n';
        continue;
      }
      if (!moved.empty() && row.starts_with("452,")) text += std::exchange(moved, "\n");
      text += row + '\n';
    }
    file.close();
    WriteText(name, text);
  }
  RunData data(Options(0));
  ASSERT_TRUE(data.track_file().has_value());
  EXPECT_EQ(ReadRest(&data).dump(), R"({"text":"","faults":[]})");
  EXPECT_FALSE(data.FlockOf("before")->file().has_value());
  for (const char* what : {"boxes", "before"}) {
    EXPECT_EQ(TextOf(data, what, 445, 455), TextOf(whole, what, 445, 455));
  }
}

TEST_F(RunDataTest, CurvesOfALargeFileAreOfSomeFrames) {
  Write(".csv", Flock());
  const RunData large(Options(0));
  const FlockRows& rows = *large.FlockOf("before");
  const Trajectories few = rows.Sample(100), all = rows.Sample(1'000'000);
  std::size_t count_few = 0, count_all = 0, wanted = 0;
  for (const Trajectory& t : few.trajectories) count_few += t.points.size();
  for (const Trajectory& t : all.trajectories) count_all += t.points.size();
  for (const Trajectory& t : Flock().trajectories) wanted += t.points.size();
  EXPECT_EQ(count_all, wanted);
  EXPECT_GT(count_few, 30u);
  EXPECT_LE(count_few, 130u);
}

TEST_F(RunDataTest, TooLongAWindowOfALargeFileIsRefused) {
  Write(".csv", Flock());
  EXPECT_THROW(RunData(Options(0)).Window("boxes", -2147483647, 2147483647), std::invalid_argument);
  EXPECT_NO_THROW(RunData(Options(kNever)).Window("boxes", -2147483647, 2147483647));
}

}  // namespace
}  // namespace flocklift
