// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "simulate/core/io.h"
#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

std::vector<Anchor> Parse(const std::string& text) {
  std::istringstream stream(text);
  return ReadAnchors(stream, "FILE");
}

TEST(Anchors, AreReadAsWritten) {
  const auto anchors = Parse("frame,id,sd,x,y,z\n7,2,0.5,1,2,3\n1,2,0.25,0,0,0\n");
  ASSERT_EQ(anchors.size(), 2u);
  EXPECT_EQ(anchors[0].frame, 7);
  EXPECT_EQ(anchors[0].id, 2);
  EXPECT_EQ(anchors[0].position, (Vec3d{1, 2, 3}));
  EXPECT_EQ(anchors[0].sd, 0.5);
}

TEST(Anchors, FaultsAreTold) {
  const std::string header = "frame,id,x,y,z,sd\n";
  const std::vector<Fault> faults{
      {"", 0, "empty"},
      {header, 0, "no rows"},
      {"frame,id,x,y,z\n1,1,0,0,0\n", 1, "column sd is missing"},
      {header + "1,1,0,0,0,0\n", 2, "sd is 0"},
      {header + "1,1,0,0,0,-1\n", 2, "sd is -1"},
      {header + "1,1,0,0,nan,1\n", 2, "z is `nan`"},
      {header + "1,-1,0,0,0,1\n", 2, "id -1"},
      {header + "1,1,0,0,0,1\n2,1,0,0,0,1\n1,1,0,0,0,1\n", 4, "stands in line 2 already"},
  };
  for (const Fault& fault : faults) ExpectFault(fault, Parse);
}

}  // namespace
}  // namespace flocklift
