// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <vector>

#include "simulate/core/io.h"
#include "simulate/core/rng.h"
#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

Trajectories Parse(const std::string& text) {
  std::istringstream stream(text);
  return ReadTrajectories(stream, "FILE");
}

Quaternion RandomRotation(Rng* rng) {
  const double q[4] = {rng->Normal(), rng->Normal(), rng->Normal(), rng->Normal()};
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
}

Trajectories RandomTrajectories() {
  Trajectories flock{.fps = 60, .trajectories = {}};
  for (Id id = 1; id <= 7; ++id) {
    Rng rng(8, static_cast<std::uint64_t>(id));
    Trajectory trajectory{.id = 3 * id, .points = {}};
    for (int frame = 1; frame < 90; ++frame) {
      if (rng.Below(5) == 0) continue;
      TrajectoryPoint point;
      point.frame = frame;
      point.position = {rng.Normal() * 1e3, rng.Normal(), rng.Normal() * 1e-5};
      point.velocity = {rng.Normal(), rng.Normal(), rng.Normal()};
      point.world_from_body = RandomRotation(&rng);
      point.sd_depth = rng.Uniform();
      trajectory.points.push_back(point);
    }
    flock.trajectories.push_back(trajectory);
  }
  return flock;
}

// Nine significant digits of the largest number of a vector.
void ExpectNear(const Vec3d& a, const Vec3d& b) {
  EXPECT_NEAR(a.x, b.x, 1e-8 * std::abs(b.x));
  EXPECT_NEAR(a.y, b.y, 1e-8 * std::abs(b.y));
  EXPECT_NEAR(a.z, b.z, 1e-8 * std::abs(b.z));
}

TEST(Trajectories, AreReadAsWritten) {
  const Trajectories flock = Parse("frame,id,x,y,z\n1,4,1,2,3\n2,4,1.5,2,-3e-1\n");
  EXPECT_EQ(flock.fps, std::nullopt);
  EXPECT_FALSE(flock.has_velocity);
  EXPECT_FALSE(flock.has_orientation);
  EXPECT_FALSE(flock.has_sd_depth);
  ASSERT_EQ(flock.trajectories.size(), 1u);
  EXPECT_EQ(flock.trajectories[0].id, 4);
  EXPECT_EQ(flock.trajectories[0].points[1].frame, 2);
  EXPECT_EQ(flock.trajectories[0].points[1].position, (Vec3d{1.5, 2, -0.3}));
  EXPECT_EQ(flock.trajectories[0].points[1].world_from_body, Quaternion{});
}

TEST(Trajectories, MayBeUntidy) {
  const Trajectories flock = Parse(
      "\xEF\xBB\xBF# made by hand\r\n\"z\", note,\"id\",y , x,frame,sd_depth,vz,vy,vx\r\n"
      "\r\n#fps=24\r\n3,high,4,2,1,2,0.5,7,6,5\r\n# low\r\n0,,4,0,0,1,0.25,0,0,0");
  EXPECT_EQ(flock.fps, 24.0);
  EXPECT_TRUE(flock.has_velocity);
  EXPECT_FALSE(flock.has_orientation);
  EXPECT_TRUE(flock.has_sd_depth);
  const TrajectoryPoint& second = flock.trajectories.at(0).points.at(1);
  EXPECT_EQ(second.frame, 2);
  EXPECT_EQ(second.position, (Vec3d{1, 2, 3}));
  EXPECT_EQ(second.velocity, (Vec3d{5, 6, 7}));
  EXPECT_EQ(second.sd_depth, 0.5);
}

TEST(Trajectories, SurviveAFileWithEveryChoiceOfColumns) {
  const TemporaryFolder folder;
  Trajectories flock = RandomTrajectories();
  for (int choice = 0; choice < 8; ++choice) {
    flock.has_velocity = choice & 1;
    flock.has_orientation = choice & 2;
    flock.has_sd_depth = choice & 4;
    WriteTrajectories(folder / "flock.csv", flock);
    WriteTrajectories(folder / "flock.h5", flock);
    for (const char* name : {"flock.csv", "flock.h5"}) {
      const Trajectories read = ReadTrajectories(folder / name);
      EXPECT_EQ(read.fps, 60.0);
      EXPECT_EQ(read.has_velocity, flock.has_velocity);
      EXPECT_EQ(read.has_orientation, flock.has_orientation);
      EXPECT_EQ(read.has_sd_depth, flock.has_sd_depth);
      ASSERT_EQ(read.trajectories.size(), flock.trajectories.size());
      for (std::size_t k = 0; k < read.trajectories.size(); ++k) {
        EXPECT_EQ(read.trajectories[k].id, flock.trajectories[k].id);
        ASSERT_EQ(read.trajectories[k].points.size(), flock.trajectories[k].points.size());
        for (std::size_t n = 0; n < read.trajectories[k].points.size(); ++n) {
          const TrajectoryPoint& a = read.trajectories[k].points[n];
          const TrajectoryPoint& b = flock.trajectories[k].points[n];
          EXPECT_EQ(a.frame, b.frame);
          ExpectNear(a.position, b.position);
          ExpectNear(a.velocity, flock.has_velocity ? b.velocity : Vec3d{});
          const Quaternion q = flock.has_orientation ? b.world_from_body : Quaternion{};
          EXPECT_NEAR(a.world_from_body.w, q.w, 1e-8);
          EXPECT_NEAR(a.world_from_body.x, q.x, 1e-8);
          EXPECT_NEAR(a.world_from_body.y, q.y, 1e-8);
          EXPECT_NEAR(a.world_from_body.z, q.z, 1e-8);
          EXPECT_NEAR(a.sd_depth, flock.has_sd_depth ? b.sd_depth : 0, 1e-9);
        }
      }
      WriteTrajectories(folder / "again.csv", read);
      EXPECT_EQ(Contents(folder / "again.csv"), Contents(folder / "flock.csv"));
    }
  }
}

TEST(Trajectories, AreWrittenByFrame) {
  const TemporaryFolder folder;
  WriteTrajectories(folder / "flock.csv",
                    Parse("frame,id,x,y,z\n2,1,0,0,0\n1,3,0.1,1e-7,123456.789\n2,3,0,0,0\n"));
  EXPECT_EQ(Contents(folder / "flock.csv"),
            "frame,id,x,y,z\n1,3,0.1,1e-07,123456.789\n2,1,0,0,0\n2,3,0,0,0\n");
}

TEST(Trajectories, RoundedQuaternionsAreNormalised) {
  const Quaternion q = Parse("frame,id,x,y,z,qw,qx,qy,qz\n1,1,0,0,0,0.7071,0,0,-0.7071\n")
                           .trajectories[0]
                           .points[0]
                           .world_from_body;
  EXPECT_DOUBLE_EQ(q.w * q.w + q.z * q.z, 1);
  EXPECT_DOUBLE_EQ(q.w, -q.z);
}

TEST(Trajectories, FaultsAreTold) {
  const std::string header = "frame,id,x,y,z\n";
  const std::string all = "frame,id,x,y,z,vx,vy,vz,qw,qx,qy,qz,sd_depth\n";
  const std::vector<Fault> faults{
      {"", 0, "empty; the first line must name frame,id,x,y,z"},
      {"# fps=3\n", 0, "empty"},
      {header, 0, "no rows"},
      {"# fps=1/0\n" + header, 1, "fps"},
      {"1,1,0,0,0\n", 1, "column frame is missing; the first line must name frame,id,x,y,z"},
      {"frame,x,y,z\n", 1, "column id is missing"},
      {"\nframe,id,x,z\n", 2, "column y is missing"},
      {"frame,id,x,y,z,vx,vz\n", 1, "column vy is missing; give its companions all together"},
      {"frame,id,x,y,z,qx,qy,qz\n", 1, "column qw is missing"},
      {"frame,id,x,y,z,x\n", 1, "column `x` occurs twice"},
      {"frame,id,x,y,z,id\n", 1, "column `id` occurs twice"},
      {header + "1,1,0,0\n", 2, "fewer"},
      {header + "1,1,0,0,0,0\n", 2, "more"},
      {header + "1,1,0,0,nan\n", 2, "z is `nan`"},
      {header + "1,1,0,-inf,0\n", 2, "y is `-inf`"},
      {header + "1,1,0,,0\n", 2, "y is empty"},
      {header + "1,1,0,1e300,0\n", 2, "y is 1e+300"},
      {header + "1,1,0,1e999,0\n", 2, "y is `1e999`"},
      {header + "1,1,a,0,0\n", 2, "x is `a`"},
      {header + "0,1,0,0,0\n", 2, "frame 0 is below 1"},
      {header + "1,0,0,0,0\n", 2, "id 0 is not positive"},
      {header + "1,-1,0,0,0\n", 2, "id -1"},
      {header + "1,1,0,0,0\n#\n\n1,1,1,1,1\n", 5, "frame 1 of id 1 stands in line 2 already"},
      {all + "1,1,0,0,0,0,0,0,1,0,0,0,-0.1\n", 2, "sd_depth is -0.1"},
      {all + "1,1,0,0,0,0,0,0,1,0,0,0.1,1\n", 2, "norm 1.00499; divide it by its norm"},
      {all + "1,1,0,0,0,0,0,0,0,0,0,0,1\n", 2, "norm 0"},
      {all + "1,1,0,0,0,0,x,0,1,0,0,0,1\n", 2, "vy is `x`"},
  };
  for (const Fault& fault : faults) ExpectFault(fault, Parse);
}

}  // namespace
}  // namespace flocklift
