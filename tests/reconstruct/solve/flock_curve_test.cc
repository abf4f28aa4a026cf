// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/flock_curve.h"

#include <gtest/gtest.h>

#include <vector>

namespace flocklift::internal {
namespace {

double ValueAt(const FlockCurve& curve, const std::vector<double>& unknowns, double time,
               int axis) {
  double value = 0;
  for (const FlockCurve::Share& share : curve.At(time, axis)) {
    value += share.weight * unknowns[static_cast<std::size_t>(share.index)];
  }
  return value;
}

TEST(FlockCurve, IsLinearBetweenKnotsAndConstantBeyond) {
  const FlockCurve curve = FlockCurve::Until(3.5, 1, 2, 2);
  EXPECT_EQ(curve.knots, 3);
  EXPECT_EQ(curve.end(), 7);
  const std::vector<double> unknowns = {99, 10, -1, 20, -2, 40, -4};
  EXPECT_DOUBLE_EQ(ValueAt(curve, unknowns, 0, 0), 10);
  EXPECT_DOUBLE_EQ(ValueAt(curve, unknowns, 0.5, 0), 12.5);
  EXPECT_DOUBLE_EQ(ValueAt(curve, unknowns, 3, 0), 30);
  EXPECT_DOUBLE_EQ(ValueAt(curve, unknowns, 3, 1), -3);
  EXPECT_DOUBLE_EQ(ValueAt(curve, unknowns, -1, 1), -1);
  EXPECT_DOUBLE_EQ(ValueAt(curve, unknowns, 9, 0), 40);
}

TEST(FlockCurve, OneKnotIsAConstant) {
  const FlockCurve curve = FlockCurve::Until(0, 0, 1, 2);
  EXPECT_EQ(curve.knots, 1);
  EXPECT_DOUBLE_EQ(ValueAt(curve, {7}, 0, 0), 7);
  EXPECT_DOUBLE_EQ(ValueAt(curve, {7}, 5, 0), 7);
}

}  // namespace
}  // namespace flocklift::internal
