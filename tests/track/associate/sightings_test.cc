// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/sightings.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

// Every third frame is missing.
std::vector<TrackPoint> Rows(int first, int last) {
  std::vector<TrackPoint> rows;
  for (int frame = first; frame <= last; ++frame) {
    if (frame % 3 == 0) continue;
    rows.emplace_back();
    rows.back().frame = frame;
    rows.back().position = {1.0 * frame, -2.0 * frame};
  }
  return rows;
}

void ExpectSame(const std::vector<TrackPoint>& a, const std::vector<TrackPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].frame, b[k].frame);
    EXPECT_EQ(a[k].position, b[k].position);
  }
}

// Everything that can be asked, against a plain list.
void ExpectList(const Sightings& sightings, const std::vector<TrackPoint>& list) {
  ASSERT_EQ(sightings.size(), list.size());
  ASSERT_EQ(sightings.empty(), list.empty());
  ExpectSame(sightings.All(), list);
  if (list.empty()) return;
  EXPECT_EQ(sightings.first_frame(), list.front().frame);
  EXPECT_EQ(sightings.last_frame(), list.back().frame);
  Rng rng(5);
  for (int k = 0; k < 200; ++k) {
    const int frame = static_cast<int>(rng.Uniform(-2, 110));
    const int end = frame + static_cast<int>(rng.Uniform(0, 60));
    const auto most = static_cast<std::size_t>(rng.Uniform(0, 40));
    std::vector<TrackPoint> between, before, from;
    for (const TrackPoint& p : list) {
      if (p.frame >= frame && p.frame <= end) between.push_back(p);
      if (p.frame >= frame && from.size() < most) from.push_back(p);
      if (p.frame < frame) before.push_back(p);
    }
    if (before.size() > most) {
      before.erase(before.begin(), before.end() - static_cast<std::ptrdiff_t>(most));
    }
    ExpectSame(sightings.Between(frame, end), between);
    ExpectSame(sightings.Before(frame, most), before);
    ExpectSame(sightings.From(frame, most), from);
  }
  ExpectSame(sightings.First(1), {list.front()});
  ExpectSame(sightings.Last(1), {list.back()});
  const SightingReader reader(sightings);
  ASSERT_EQ(reader.size(), list.size());
  EXPECT_EQ(reader.front().frame, list.front().frame);
  for (std::size_t k = 0; k < list.size(); ++k) {
    EXPECT_EQ(reader[k].frame, list[k].frame);
    if (k + 1 == list.size()) continue;
    EXPECT_EQ(reader[k + 1].frame, list[k + 1].frame);
  }
  reader.Release();
}

class SightingsTest : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(path_); }
  void TearDown() override { fs::remove_all(path_); }

  // Frames 1 to 100: two stretches in the file, one in memory.
  static Sightings Mixed(SightingFile* file) {
    Sightings sightings;
    sightings.Append(Rows(1, 30), 7, file);
    file->Append(8, Rows(1, 5));  // another's
    sightings.Append(Rows(31, 80), 7, file);
    sightings.Append(Rows(81, 100));
    return sightings;
  }

  const fs::path path_ = fs::path(testing::TempDir()) / "sightings_test";
};

TEST_F(SightingsTest, AreTheSameInMemoryAndInAFile) {
  SightingFile file(path_);
  ExpectList(Sightings(Rows(1, 100)), Rows(1, 100));
  ExpectList(Mixed(&file), Rows(1, 100));
  ExpectList({}, {});
}

TEST_F(SightingsTest, AreCutAnywhereAndPutTogether) {
  SightingFile file(path_);
  for (const int frame : {-1, 1, 2, 17, 30, 31, 34, 80, 81, 90, 100, 101, 200}) {
    Sightings head = Mixed(&file);
    Sightings tail = head.CutFrom(frame);
    ExpectList(head, Rows(1, std::min(frame - 1, 100)));
    ExpectList(tail, Rows(std::max(frame, 1), 100));
    head.Append(std::move(tail));
    ExpectList(head, Rows(1, 100));
  }
}

TEST_F(SightingsTest, ExchangeTheirTails) {
  SightingFile file(path_);
  Sightings stored = Mixed(&file), plain(Rows(1, 100));
  Sightings a = stored.CutFrom(20), b = plain.CutFrom(50);
  stored.Append(std::move(b));
  plain.Append(std::move(a).CutFrom(60));
  std::vector<TrackPoint> wanted = Rows(1, 19), later = Rows(50, 100);
  wanted.insert(wanted.end(), later.begin(), later.end());
  ExpectList(stored, wanted);
  wanted = Rows(1, 49), later = Rows(60, 100);
  wanted.insert(wanted.end(), later.begin(), later.end());
  ExpectList(plain, wanted);
}

TEST_F(SightingsTest, AFileTellsItsStretchesAgain) {
  std::uint64_t size = 0;
  {
    SightingFile file(path_);
    Mixed(&file);
    size = file.size();
    file.Append(9, Rows(1, 10));  // later than what is taken
  }
  SightingFile file(path_);
  Sightings found, other;
  file.GoOn(size, [&](std::uint64_t animal, std::uint64_t at, std::size_t count) {
    EXPECT_TRUE(animal == 7 || animal == 8);
    (animal == 7 ? found : other).AppendStored(file, at, count);
  });
  EXPECT_EQ(file.size(), size);
  ExpectList(found, Rows(1, 80));
  ExpectList(other, Rows(1, 5));
  const auto ignore = [](std::uint64_t, std::uint64_t, std::size_t) {};
  SightingFile cut(path_);
  EXPECT_THROW(cut.GoOn(size - 1, ignore), std::runtime_error);
}

}  // namespace
}  // namespace flocklift
