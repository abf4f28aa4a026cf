// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/folder_path.h"

#include <gtest/gtest.h>

#include <fstream>

namespace flocklift {
namespace {

namespace fs = std::filesystem;

class FolderPath : public testing::Test {
 protected:
  void SetUp() override {
    base_ = fs::path(testing::TempDir()) /
            ("folder_path_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
             testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(base_);
    fs::create_directories(base_ / "run" / "replay");
    fs::create_directories(base_ / "run2");
    std::ofstream(base_ / "secret.txt") << "secret";
    std::ofstream(base_ / "run" / "tracks.csv") << "1";
    std::ofstream(base_ / "run2" / "other.csv") << "2";
  }
  void TearDown() override { fs::remove_all(base_); }

  fs::path base_;
};

TEST_F(FolderPath, FindsWhatIsInside) {
  EXPECT_EQ(PathInFolder(base_ / "run", "tracks.csv"), fs::canonical(base_ / "run/tracks.csv"));
  EXPECT_EQ(PathInFolder(base_ / "run", "replay/new.csv"),
            fs::canonical(base_ / "run/replay") / "new.csv");
  EXPECT_EQ(PathInFolder(base_ / "run", "./tracks.csv"), fs::canonical(base_ / "run/tracks.csv"));
}

TEST_F(FolderPath, LeavesTheFolderByNoName) {
  for (const std::string& name : std::vector<std::string>{
           "", ".", "..", "../secret.txt", "replay/../../secret.txt", "/etc/passwd",
           "../run2/other.csv", "....//secret.txt/../..", std::string("tracks.csv\0.png", 15),
           (base_ / "run" / "tracks.csv").string()}) {
    EXPECT_FALSE(PathInFolder(base_ / "run", name)) << name;
  }
}

TEST_F(FolderPath, FollowsNoLinkOutside) {
  fs::create_symlink(base_ / "secret.txt", base_ / "run" / "link.txt");
  fs::create_directory_symlink(base_ / "run2", base_ / "run" / "folder");
  fs::create_symlink(base_ / "nowhere.txt", base_ / "run" / "dangling.txt");
  fs::create_symlink(base_ / "run" / "tracks.csv", base_ / "run" / "inside.csv");
  EXPECT_FALSE(PathInFolder(base_ / "run", "link.txt"));
  EXPECT_FALSE(PathInFolder(base_ / "run", "folder/other.csv"));
  EXPECT_FALSE(PathInFolder(base_ / "run", "dangling.txt"));
  EXPECT_EQ(PathInFolder(base_ / "run", "inside.csv"), fs::canonical(base_ / "run/tracks.csv"));
}

TEST(PlainFileName, TakesNamesAndNoPaths) {
  EXPECT_TRUE(IsPlainFileName("a.toml", ".toml"));
  EXPECT_TRUE(IsPlainFileName("boids3d_steered-2.toml", ".toml"));
  for (const char* name : {".toml", "a.csv", "../a.toml", "a/b.toml", "a b.toml", ".a.toml",
                           "a\\b.toml", "\xc3\xa4.toml", "a:b.toml"}) {
    EXPECT_FALSE(IsPlainFileName(name, ".toml")) << name;
  }
  std::string long_name(200, 'a');
  long_name += ".toml";
  EXPECT_FALSE(IsPlainFileName(long_name, ".toml"));
}

}  // namespace
}  // namespace flocklift
