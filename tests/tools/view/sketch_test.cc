// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/sketch.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace flocklift {
namespace {

TEST(EvenlyAlong, HasEqualStepsOverCorners) {
  const std::vector<Vec3d> line = {{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 1, 0}};
  const auto points = EvenlyAlong(line, 5);
  ASSERT_EQ(points.size(), 5u);
  EXPECT_EQ(points[0], (Vec3d{0, 0, 0}));
  EXPECT_EQ(points[2], (Vec3d{2, 0, 0}));
  EXPECT_EQ(points[4], (Vec3d{3, 1, 0}));
  for (const Vec3d& p : EvenlyAlong(std::vector<Vec3d>{{1, 2, 3}, {1, 2, 3}}, 3)) {
    EXPECT_EQ(p, (Vec3d{1, 2, 3}));
  }
}

TEST(Strokes, BecomeTracksOfAnEvenPace) {
  const auto strokes = StrokesOf(nlohmann::ordered_json::parse(
      R"({"strokes": [{"first": 3, "last": 7, "points": [[0, 0], [4, 0], [8, 0]]},
                      {"first": 1, "last": 2, "points": [[5, 5], [6, 6]]}]})"));
  const Tracks tracks = TracksOfStrokes(strokes, 10);
  ASSERT_EQ(tracks.tracklets.size(), 2u);
  EXPECT_EQ(tracks.tracklets[1].id, 2);
  const auto& d = tracks.tracklets[0].detections;
  ASSERT_EQ(d.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(d[k].frame, static_cast<int>(k) + 3);
    EXPECT_DOUBLE_EQ(d[k].box.Center().x, 2.0 * static_cast<double>(k));
    EXPECT_EQ(d[k].box.width, 10);
  }
}

TEST(Strokes, AreChecked) {
  for (const char* text :
       {R"({"strokes": []})", R"({"strokes": [{"first": 1, "last": 1, "points": [[0,0],[1,1]]}]})",
        R"({"strokes": [{"first": 0, "last": 9, "points": [[0,0],[1,1]]}]})",
        R"({"strokes": [{"first": 1, "last": 900000000, "points": [[0,0],[1,1]]}]})",
        R"({"strokes": [{"first": 1, "last": 9, "points": [[0,0]]}]})",
        R"({"strokes": [{"first": 1, "last": 9, "points": [[0,0],[1e30,1]]}]})"}) {
    EXPECT_THROW(StrokesOf(nlohmann::ordered_json::parse(text)), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace flocklift
