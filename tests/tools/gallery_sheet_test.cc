// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/gallery_sheet.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/media/image_codec.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

class GallerySheetTest : public testing::Test {
 protected:
  GallerySheetTest()
      : folder_(fs::path(testing::TempDir()) /
                ("flocklift_gallery_" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~GallerySheetTest() override { fs::remove_all(folder_); }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  fs::path folder_;
};

Image Plain(int width, int height, std::uint8_t level) {
  Image image(width, height);
  std::fill(image.bgr.begin(), image.bgr.end(), level);
  return image;
}

constexpr char kSummary[] = R"({"figures": {"agents": 5000, "steps": 600, "mde_share": 0.0068},
  "phases": [{"name": "prepare", "wall_s": 9, "cpu_s": 9},
             {"name": "step", "wall_s": 0.2, "cpu_s": 0.1}]})";

TEST_F(GallerySheetTest, ReadsARun) {
  Write("summary.simulate.json", kSummary);
  WritePng(folder_ / "still.png", Plain(32, 18, 9));
  const GalleryEntry entry = ReadGalleryEntry(folder_, "locusts");
  EXPECT_EQ(entry.name, "locusts");
  EXPECT_EQ(entry.agents, 5000);
  EXPECT_NEAR(entry.steps_per_second, 6000, 1e-6);
  EXPECT_NEAR(entry.mde_share, 0.0068, 1e-12);
  EXPECT_EQ(entry.still.width, 32);
}

TEST_F(GallerySheetTest, SaysWhatIsMissing) {
  EXPECT_THROW(ReadGalleryEntry(folder_, "x"), InputError);
  Write("summary.simulate.json", "{}");
  EXPECT_THROW(ReadGalleryEntry(folder_, "x"), InputError);
  Write("summary.simulate.json", kSummary);
  EXPECT_THROW(ReadGalleryEntry(folder_, "x"), InputError);  // no picture
  Write("papers.csv", "scene,frames per second,MDE\nlocusts,12\n");
  EXPECT_THROW(ReadPaperFigures(folder_ / "papers.csv"), InputError);
}

TEST_F(GallerySheetTest, ReadsWhatThePapersSay) {
  Write("papers.csv",
        "# note\nscene,frames per second,MDE\n\nlocusts,12 (GPU 659),0.68 %\nwords,185,\n");
  const std::vector<PaperFigures> papers = ReadPaperFigures(folder_ / "papers.csv");
  ASSERT_EQ(papers.size(), 2U);
  EXPECT_EQ(papers[0].name, "locusts");
  EXPECT_EQ(papers[0].rate, "12 (GPU 659)");
  EXPECT_EQ(papers[0].mde, "0.68 %");
  EXPECT_EQ(papers[1].mde, "");
}

std::vector<GalleryEntry> Entries(int count) {
  std::vector<GalleryEntry> entries;
  for (int k = 0; k < count; ++k) {
    entries.push_back({.name = "scene" + std::to_string(k),
                       .agents = 256'000,
                       .steps_per_second = 61.234,
                       .mde_share = k == 0 ? 0.0068 : 0,
                       .paper_rate = k == 0 ? "12" : "",
                       .paper_mde = k == 0 ? "0.68 %" : "",
                       .still = Plain(64, 36, static_cast<std::uint8_t>(20 * (k + 1)))});
  }
  return entries;
}

TEST_F(GallerySheetTest, TheTableHasARowEach) {
  const std::string table = GalleryTable(Entries(2));
  EXPECT_NE(table.find("| `scene0` | 256 000 | 61.2 | 12 | 0.68 % | 0.68 % |\n"), std::string::npos)
      << table;
  EXPECT_NE(table.find("| `scene1` | 256 000 | 61.2 | - | 0 | - |\n"), std::string::npos) << table;
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
}

TEST_F(GallerySheetTest, ThePicturesStandInRowsWithCaptions) {
  const Image sheet = ContactSheet(Entries(5), 3);
  EXPECT_EQ(sheet.width, 3 * 64 + 4 * 6);
  EXPECT_GT(sheet.height, 2 * (36 + 20));
  // The middle of each picture, in reading order.
  const int line = (sheet.height - 6) / 2;
  for (int k = 0; k < 5; ++k) {
    const int u = 6 + k % 3 * 70 + 32, v = 6 + k / 3 * line + 18;
    EXPECT_EQ(sheet.Row(v)[3 * u], 20 * (k + 1)) << k;
  }
  int written = 0;
  for (int u = 0; u < 64; ++u) written += sheet.Row(6 + 36 + 14)[3 * (6 + u)] > 150 ? 1 : 0;
  EXPECT_GT(written, 5);
  EXPECT_THROW(ContactSheet({}, 3), std::invalid_argument);
  std::vector<GalleryEntry> odd = Entries(2);
  odd[1].still = Plain(10, 10, 0);
  EXPECT_THROW(ContactSheet(odd, 3), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
