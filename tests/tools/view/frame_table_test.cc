// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/frame_table.h"

#include <gtest/gtest.h>

#include <cstring>

namespace flocklift {
namespace {

// Animal 7 in frames 3 and 4, animal 2 in frame 4 and, after a gap, in frame 6.
Trajectories Two() {
  Trajectories t;
  t.has_velocity = t.has_sd_depth = true;
  const auto point = [](int frame, double x, double sd) {
    TrajectoryPoint p;
    p.frame = frame;
    p.position = {x, x + 0.5, -x};
    p.velocity = {0, 2, 0};
    p.sd_depth = sd;
    return p;
  };
  t.trajectories = {{2, {point(4, 40, 0.1), point(6, 60, 0.2)}},
                    {7, {point(3, 3, 0.3), point(4, 4, 0.4)}}};
  return t;
}

AnimalList Listed() {
  AnimalList animals;
  for (const Id id : {2, 5, 2, 7}) animals.Add(id);
  return animals;
}

template <typename T>
std::vector<T> Take(const std::string& bytes, std::size_t* at, std::size_t count) {
  std::vector<T> values(count);
  std::memcpy(values.data(), bytes.data() + *at, count * sizeof(T));
  *at += count * sizeof(T);
  return values;
}

TEST(AnimalList, KeepsThePlacesOfThoseWhoWereThere) {
  AnimalList animals = Listed();
  EXPECT_EQ(animals.ids(), (std::vector<Id>{2, 5, 7}));
  EXPECT_EQ(animals.IndexOf(7), 2u);
  EXPECT_THROW(animals.IndexOf(3), std::invalid_argument);
  animals.Add(3);
  animals.Add(7);
  EXPECT_EQ(animals.ids(), (std::vector<Id>{2, 5, 7, 3}));
}

TEST(FrameTable, IsByPlaceWhereIdsCameInAnotherOrder) {
  AnimalList animals;
  for (const Id id : {7, 2}) animals.Add(id);
  const TrajectoryTable table = TableOf(Two(), animals);
  EXPECT_EQ(table.rows.animal, (std::vector<std::uint32_t>{0, 0, 1, 1}));
  EXPECT_EQ(table.position[3], 4.f);
  EXPECT_EQ(table.position[6], 40.f);
}

TEST(FrameTable, IsByFrameThenAnimal) {
  const TrajectoryTable table = TableOf(Two(), Listed());
  EXPECT_EQ(table.rows.first_frame, 3);
  EXPECT_EQ(table.rows.start, (std::vector<std::uint32_t>{0, 1, 3, 3, 4}));
  EXPECT_EQ(table.rows.animal, (std::vector<std::uint32_t>{2, 0, 2, 0}));
  EXPECT_EQ(table.position[0], 3.f);
  EXPECT_EQ(table.position[3], 40.f);
  EXPECT_EQ(table.position[6], 4.f);
  EXPECT_FLOAT_EQ(table.sd_depth[3], 0.2f);
  // Level along +y: a turn by 90 degrees about z.
  EXPECT_NEAR(table.orientation[0] / 32767.0, std::sqrt(0.5), 1e-4);
  EXPECT_NEAR(table.orientation[3] / 32767.0, std::sqrt(0.5), 1e-4);
}

TEST(FrameTable, PacksAWindowAsThePageReadsIt) {
  const std::string bytes = PackWindow(TableOf(Two(), Listed()), 4, 5);
  std::size_t at = 0;
  EXPECT_EQ(bytes.substr(0, 4), "FLKW");
  EXPECT_EQ(Take<std::uint32_t>(bytes, &at, 8),
            (std::vector<std::uint32_t>{0x574b4c46, 0, 4, 2, 2, 0, 0, 0}));
  EXPECT_EQ(Take<std::uint32_t>(bytes, &at, 3), (std::vector<std::uint32_t>{0, 2, 2}));
  EXPECT_EQ(Take<std::uint32_t>(bytes, &at, 2), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(Take<float>(bytes, &at, 6), (std::vector<float>{40, 40.5, -40, 4, 4.5, -4}));
  EXPECT_EQ(Take<float>(bytes, &at, 6), (std::vector<float>{0, 2, 0, 0, 2, 0}));
  EXPECT_EQ(Take<float>(bytes, &at, 2), (std::vector<float>{0.1f, 0.4f}));
  Take<std::int16_t>(bytes, &at, 8);
  EXPECT_EQ(at, bytes.size());
}

TEST(FrameTable, PacksNothingOutsideItsFrames) {
  const TrajectoryTable table = TableOf(Two(), Listed());
  for (const auto& [first, last] : {std::pair{-5, 2}, {7, 900}, {5, 4}, {2147483647, 2147483647}}) {
    const std::string bytes = PackWindow(table, first, last);
    EXPECT_EQ(bytes.size(), 36u) << first;
  }
  EXPECT_EQ(PackWindow(table, -2147483647, 2147483647), PackWindow(table, 3, 6));
  EXPECT_EQ(PackWindow(TrajectoryTable{}, 1, 10).size(), 36u);
}

TEST(FrameTable, PacksBoxes) {
  Tracks tracks;
  Detection d;
  d.frame = 2;
  d.box = {1, 2, 3, 4};
  d.confidence = 0.25;
  tracks.tracklets = {{5, {d}}};
  const std::string bytes = PackWindow(TableOf(tracks, Listed()), 1, 9);
  std::size_t at = 0;
  EXPECT_EQ(Take<std::uint32_t>(bytes, &at, 8),
            (std::vector<std::uint32_t>{0x574b4c46, 1, 2, 1, 1, 0, 0, 0}));
  Take<std::uint32_t>(bytes, &at, 2);
  EXPECT_EQ(Take<std::uint32_t>(bytes, &at, 1), (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(Take<float>(bytes, &at, 5), (std::vector<float>{1, 2, 3, 4, 0.25}));
  EXPECT_EQ(at, bytes.size());
}

}  // namespace
}  // namespace flocklift
