// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/scratch_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace flocklift::internal {
namespace {

namespace fs = std::filesystem;

class ScratchFileTest : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  static std::uint64_t Append(const std::string& text, ScratchFile* file) {
    return file->Append(std::as_bytes(std::span(text)));
  }
  static std::string Read(const ScratchFile& file, std::uint64_t at, std::size_t size) {
    std::string text(size, ' ');
    file.Read(at, std::as_writable_bytes(std::span(text)));
    return text;
  }
  std::size_t Entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / "scratch_file_test";
};

TEST_F(ScratchFileTest, GivesBackWhatItWasGiven) {
  ScratchFile file(folder_ / "kept", ScratchFile::Name::kKept);
  EXPECT_FALSE(fs::exists(folder_));
  EXPECT_EQ(Append("one", &file), 0u);
  EXPECT_EQ(Append("three", &file), 3u);
  EXPECT_EQ(file.size(), 8u);
  EXPECT_EQ(Read(file, 3, 5), "three");
  EXPECT_EQ(Read(file, 1, 4), "neth");
  EXPECT_THROW(Read(file, 4, 5), std::runtime_error);
}

TEST_F(ScratchFileTest, GoesOnFromTheFirstBytes) {
  {
    ScratchFile file(folder_ / "kept", ScratchFile::Name::kKept);
    Append("one and two", &file);
  }
  ScratchFile file(folder_ / "kept", ScratchFile::Name::kKept);
  file.GoOn(4);
  Append("more", &file);
  EXPECT_EQ(Read(file, 0, 8), "one more");
  EXPECT_EQ(fs::file_size(folder_ / "kept"), 8u);
}

TEST_F(ScratchFileTest, WithoutANameNothingStandsInTheFolder) {
  ScratchFile file(folder_ / "nobody", ScratchFile::Name::kNoName);
  Append("something", &file);
  EXPECT_EQ(Entries(), 0u);
  EXPECT_EQ(Read(file, 4, 5), "thing");
}

TEST_F(ScratchFileTest, SaysWhichFileCannotBeWritten) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "file") << "no folder";
  ScratchFile file(folder_ / "file" / "below", ScratchFile::Name::kKept);
  EXPECT_THROW(Append("x", &file), std::runtime_error);
}

}  // namespace
}  // namespace flocklift::internal
