// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "simulate/core/io.h"
#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

Tracks ThreeRows() {
  std::istringstream stream("1,1,1,1,2,2\n2,1,1,1,2,2\n1,5,1,1,2,2\n");
  return ReadTracks(stream, "FILE");
}

Tracks Parse(const std::string& text) {
  Tracks tracks = ThreeRows();
  std::istringstream stream(text);
  ReadShapes(stream, "FILE", &tracks);
  return tracks;
}

TEST(Shapes, FindTheirDetections) {
  const Tracks tracks =
      Parse("id,frame,area,angle,minor,major,note\n5,1,9,0,2,4,x\n1,2,8.5,179.5,3,3,y\n");
  EXPECT_FALSE(tracks.tracklets[0].detections[0].shape);
  const std::optional<Shape>& shape = tracks.tracklets[0].detections[1].shape;
  ASSERT_TRUE(shape);
  EXPECT_EQ(shape->major, 3);
  EXPECT_EQ(shape->minor, 3);
  EXPECT_EQ(shape->angle_deg, 179.5);
  EXPECT_EQ(shape->area, 8.5);
  EXPECT_TRUE(tracks.tracklets[1].detections[0].shape);
}

TEST(Shapes, SurviveAFile) {
  const TemporaryFolder folder;
  Tracks tracks = ThreeRows();
  tracks.tracklets[0].detections[1].shape = Shape{12.34567, 0, 179.999999, 33.1};
  tracks.tracklets[1].detections[0].shape = Shape{1e-9, 1e-9, 90, 1e-9};
  WriteShapes(folder / "shapes.csv", tracks);
  Tracks read = ThreeRows();
  ReadShapes(folder / "shapes.csv", &read);
  const Shape& shape = *read.tracklets[0].detections[1].shape;
  EXPECT_NEAR(shape.major, 12.34567, 1e-4);
  EXPECT_EQ(shape.minor, 0);
  EXPECT_EQ(shape.angle_deg, 0);  // 180 is the same direction
  WriteShapes(folder / "again.csv", read);
  EXPECT_EQ(Contents(folder / "again.csv"), Contents(folder / "shapes.csv"));
}

TEST(Shapes, HalfATurnIsNone) {
  std::istringstream csv("frame,id,major,minor,angle,area\n1,1,4,2,180.00,9\n");
  Tracks tracks = ThreeRows();
  ReadShapes(csv, "shapes.csv", &tracks);
  EXPECT_EQ(tracks.tracklets[0].detections[0].shape->angle_deg, 0);
}

TEST(Shapes, NoneIsNoFault) {
  const TemporaryFolder folder;
  WriteShapes(folder / "shapes.csv", ThreeRows());
  EXPECT_EQ(Contents(folder / "shapes.csv"), "frame,id,major,minor,angle,area\n");
  Tracks tracks = ThreeRows();
  ReadShapes(folder / "shapes.csv", &tracks);
}

TEST(Shapes, FaultsAreTold) {
  const std::string header = "frame,id,major,minor,angle,area\n";
  const std::vector<Fault> faults{
      {"", 0, "empty"},
      {"frame,id,major,minor,angle\n", 1, "column area is missing"},
      {header + "1,1,4,2,0,9\n1,1,4,2,0,9\n", 3, "has a shape already"},
      {header + "3,1,4,2,0,9\n", 2, "frame 3 of id 1 is not in the tracks"},
      {header + "1,4,4,2,0,9\n", 2, "frame 1 of id 4 is not in the tracks"},
      {header + "1,6,4,2,0,9\n", 2, "frame 1 of id 6 is not in the tracks"},
      {header + "1,-1,4,2,0,9\n", 2, "belongs to no animal"},
      {header + "1,1,2,4,0,9\n", 2, "axes are 2 and 4"},
      {header + "1,1,0,0,0,9\n", 2, "axes are 0 and 0"},
      {header + "1,1,4,-2,0,9\n", 2, "axes are 4 and -2"},
      {header + "1,1,4,2,180.1,9\n", 2, "angle is 180.1"},
      {header + "1,1,4,2,-1,9\n", 2, "angle is -1"},
      {header + "1,1,4,2,0,0\n", 2, "area is 0"},
      {header + "1,1,4,2,0,nan\n", 2, "area is `nan`"},
  };
  for (const Fault& fault : faults) ExpectFault(fault, Parse);
}

}  // namespace
}  // namespace flocklift
