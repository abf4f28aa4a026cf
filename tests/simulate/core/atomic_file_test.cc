// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/atomic_file.h"

#include <gtest/gtest.h>

#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

std::size_t FileCount(const TemporaryFolder& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    ++count;
  }
  return count;
}

TEST(AtomicFile, AppearsWhenCommitted) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "new/folder/file.csv";
  AtomicFile file(path);
  EXPECT_EQ(file.temporary().extension(), ".csv");
  EXPECT_EQ(file.temporary().parent_path(), path.parent_path());
  std::ofstream(file.temporary()) << "new";
  EXPECT_FALSE(std::filesystem::exists(path));
  file.Commit();
  EXPECT_EQ(Contents(path), "new");
  EXPECT_FALSE(std::filesystem::exists(file.temporary()));
}

TEST(AtomicFile, LeavesNothingAndTheOldFileWithoutCommit) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "file.csv";
  WriteTextFile(path, "old");
  {
    AtomicFile file(path);
    std::ofstream(file.temporary()) << "new";
    EXPECT_EQ(FileCount(folder), 2u);
  }
  EXPECT_EQ(Contents(path), "old");
  EXPECT_EQ(FileCount(folder), 1u);
}

TEST(AtomicFile, TwoOfOneNameDoNotMeet) {
  const TemporaryFolder folder;
  const AtomicFile one(folder / "file.csv"), two(folder / "file.csv");
  EXPECT_NE(one.temporary(), two.temporary());
}

TEST(WriteTextFile, SaysWhereItCannotWrite) {
  const TemporaryFolder folder;
  WriteTextFile(folder / "file", "x");
  try {
    WriteTextFile(folder / "file/below.txt", "x");
    ADD_FAILURE() << "a file is no folder";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("file"), std::string::npos);
  }
}

}  // namespace
}  // namespace flocklift
