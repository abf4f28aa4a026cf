// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/dynamics_report.h"

#include <gtest/gtest.h>

namespace flocklift {
namespace {

TEST(DynamicsReport, WindowsCountByWhatWasHiddenAndByWhetherForcesCount) {
  const DynamicsReport with{.windows = 1,
                            .kept = 1,
                            .weight = 0.5,
                            .hidden = 100,
                            .batch_error = 4,
                            .dynamics_error = 2,
                            .forces = {{"d_s", 1.5}}};
  const DynamicsReport without{
      .windows = 1, .hidden = 300, .batch_error = 8, .dynamics_error = 10, .forces = {}};
  DynamicsReport all;
  Merge({}, &all);  // a window too short to hide anything
  Merge(with, &all);
  Merge(without, &all);
  EXPECT_EQ(all.windows, 2);
  EXPECT_EQ(all.kept, 1);
  EXPECT_EQ(all.weight, 0.5);
  EXPECT_EQ(all.hidden, 400);
  EXPECT_DOUBLE_EQ(all.batch_error, 7);
  EXPECT_DOUBLE_EQ(all.dynamics_error, 8);
  EXPECT_EQ(all.forces, with.forces);
  DynamicsReport later = with;
  later.weight = 1;
  later.forces[0].second = 2;
  Merge(later, &all);
  EXPECT_DOUBLE_EQ(all.weight, 0.75);
  EXPECT_EQ(all.forces, later.forces);
}

}  // namespace
}  // namespace flocklift
