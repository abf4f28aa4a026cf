// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/depth_curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace flocklift {
namespace {

// Every sweep goes through the case as it is, changes it elsewhere, and changes one thing only.
TEST(DepthSweeps, EachChangesOneThing) {
  const DepthCase plain{.scene = "circling"};
  for (const DepthSweep& sweep : DepthSweeps()) {
    for (const double amount : sweep.amounts) {
      DepthCase changed = plain;
      sweep.apply(amount, &changed);
      const int changes = (changed.faults.switches != plain.faults.switches) +
                          (changed.noise.miss != plain.noise.miss) +
                          (changed.noise.position_sd != plain.noise.position_sd) +
                          (changed.told_speed != plain.told_speed) +
                          (changed.told_focal != plain.told_focal);
      const bool is_plain =
          sweep.name == "position noise [px]" ? amount == plain.noise.position_sd : amount == 0;
      EXPECT_EQ(changes, is_plain ? 0 : 1) << sweep.name << " " << amount;
    }
  }
}

DepthPanel SomePanel() {
  return {{.name = "misses < 3 [%]", .amounts = {0, 10}},
          {{"batch", {0.031, 0.042}, {0.02, 0.025}}, {"cobyla", {0.2, 0.9}, {0.1, 0.12}}}};
}

TEST(DepthCurves, TheTableHoldsEveryFigure) {
  const std::string table = DepthCurvesTable({SomePanel()});
  EXPECT_THAT(table, testing::HasSubstr("| misses < 3 [%] | 0 | batch | 3.10 | 2.00 |\n"));
  EXPECT_THAT(table, testing::HasSubstr("| misses < 3 [%] | 10 | cobyla | 90.00 | 12.00 |\n"));
}

TEST(DepthCurves, ThePictureIsAFileOfItsOwn) {
  const std::string svg = DepthCurvesPicture({SomePanel(), SomePanel()});
  EXPECT_THAT(svg, testing::StartsWith("<svg xmlns="));
  EXPECT_THAT(svg, testing::HasSubstr("misses &lt; 3 [%]"));
  EXPECT_THAT(svg, testing::HasSubstr("--c0:"));
  EXPECT_THAT(svg, testing::HasSubstr("cobyla"));
}

TEST(DepthCurves, ACurveWithoutAllItsErrorsIsRefused) {
  DepthPanel panel = SomePanel();
  panel.curves[0].scaled.pop_back();
  EXPECT_THROW(DepthCurvesTable({panel}), std::invalid_argument);
  EXPECT_THROW(DepthCurvesPicture({panel}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
