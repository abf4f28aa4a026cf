// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report/run_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "simulate/core/atomic_file.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

// A run in work/result, of a film that it calls by its name from the folder above `work`.
class RunFolderTest : public testing::Test {
 protected:
  RunFolderTest() : above_(fs::path(testing::TempDir()) / "run_folder_test") {
    fs::remove_all(above_);
    for (const char* name : {"work/films", "work/result/replay"}) {
      fs::create_directories(above_ / name);
    }
    WriteTextFile(Result() / "tracks.csv", "1,1,2,3,4,5,1,-1,-1,-1\n");
    WriteTextFile(Result() / "replay/video.mp4", "another");
    WriteTextFile(
        Result() / "summary.track.json",
        R"({"command": "track", "version": "0.1.0", "options": {}, "outputs": [], "figures": {},
            "inputs": [{"name": "work/films/birds.mp4", "sha256": ""}]})");
  }
  fs::path Result() const { return above_ / "work/result"; }

  fs::path above_;
};

TEST_F(RunFolderTest, FindsTheFilmFromElsewhere) {
  WriteTextFile(above_ / "work/films/birds.mp4", "x");
  const RunFolder run = ReadRunFolder(Result(), std::nullopt, std::nullopt, true);
  ASSERT_TRUE(run.video);
  EXPECT_TRUE(fs::equivalent(*run.video, above_ / "work/films/birds.mp4"));
}

TEST_F(RunFolderTest, TheFilmOfTheReplayIsNotWhatWasTracked) {
  EXPECT_FALSE(ReadRunFolder(Result(), std::nullopt, std::nullopt, true).video);
}

TEST_F(RunFolderTest, AReplayThatIsLookedAtItselfHasItsFilm) {
  const fs::path replay = Result() / "replay";
  WriteTextFile(replay / "trajectories.csv", "frame,id,x,y,z\n1,1,0,0,0\n");
  const RunFolder run = ReadRunFolder(replay, std::nullopt, std::nullopt, true);
  ASSERT_TRUE(run.video);
  EXPECT_TRUE(fs::equivalent(*run.video, replay / "video.mp4"));
}

}  // namespace
}  // namespace flocklift
