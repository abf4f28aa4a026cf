// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/grid_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

ScalarField Fill(const Grid& grid, const std::function<double(const Vec3d&)>& f) {
  ScalarField field{grid, {}};
  for (std::size_t k = 0; k < grid.size(); ++k) {
    field.values.push_back(static_cast<float>(f(grid.Node(k))));
  }
  return field;
}

const Grid kGrid{{-1, 2, 0.5}, 0.25, 9, 7, 8};

Vec3d Inside(const Grid& g, Rng* rng, double margin) {
  const Vec3d low = g.low + Vec3d{margin, margin, margin};
  const Vec3d high = g.High() - Vec3d{margin, margin, margin};
  return {rng->Uniform(low.x, high.x), rng->Uniform(low.y, high.y), rng->Uniform(low.z, high.z)};
}

TEST(Grid, CoversItsBox) {
  const Grid grid = GridOver({0, 0, 1}, {0.3, 1, 1}, 0.1);
  EXPECT_EQ(grid, (Grid{{0, 0, 1}, 0.1, 4, 11, 1}));
  EXPECT_EQ(GridOver({0, 0, 0}, {0.31, 1, 1}, 0.1).nx, 5);
  EXPECT_THROW(GridOver({0, 0, 0}, {1, -1, 1}, 0.1), std::invalid_argument);
  EXPECT_THROW(GridOver({0, 0, 0}, {1, 1, 1}, 0), std::invalid_argument);
  EXPECT_THROW(GridOver({0, 0, 0}, {1, 1, 1}, 1e-5), std::invalid_argument);
}

TEST(Grid, NumbersItsNodes) {
  for (std::size_t k = 0; k < kGrid.size(); ++k) {
    EXPECT_EQ(kGrid.Nearest(kGrid.Node(k) + Vec3d{0.1, -0.12, 0.05}), k);
  }
  EXPECT_EQ(kGrid.Node(kGrid.Index(2, 3, 4)), kGrid.Node(2, 3, 4));
  EXPECT_EQ(kGrid.High(), (Vec3d{1, 3.5, 2.25}));
  EXPECT_EQ(kGrid.Nearest({-9, -9, 99}), kGrid.Index(0, 0, 7));
}

TEST(ScalarField, LinearReproducesATrilinearFunction) {
  const auto f = [](const Vec3d& p) { return 1 + 2 * p.x - p.y + 0.5 * p.z + p.x * p.y * p.z; };
  const ScalarField field = Fill(kGrid, f);
  Rng rng(1);
  for (int k = 0; k < 300; ++k) {
    const Vec3d p = Inside(kGrid, &rng, 0);
    const FieldSample sample = field.SampleLinear(p);
    EXPECT_NEAR(sample.value, f(p), 1e-5);
    EXPECT_EQ(field.Sample(p), sample.value);
    EXPECT_NEAR(sample.gradient.x, 2 + p.y * p.z, 2e-5);
    EXPECT_NEAR(sample.gradient.y, -1 + p.x * p.z, 2e-5);
    EXPECT_NEAR(sample.gradient.z, 0.5 + p.x * p.y, 2e-5);
  }
  for (std::size_t k = 0; k < kGrid.size(); ++k) {
    EXPECT_FLOAT_EQ(static_cast<float>(field.Sample(kGrid.Node(k))), field.values[k]);
  }
}

TEST(ScalarField, SmoothReproducesALinearFunctionAndShiftsASquareByAnEighth) {
  const ScalarField line = Fill(kGrid, [](const Vec3d& p) { return 3 - p.x + 2 * p.y + 4 * p.z; });
  const ScalarField bowl = Fill(kGrid, [](const Vec3d& p) { return p.x * p.x + p.y * p.z; });
  Rng rng(1);
  for (int k = 0; k < 300; ++k) {
    const Vec3d p = Inside(kGrid, &rng, kGrid.spacing);  // the rim repeats its last node
    const SmoothSample s = line.SampleSmooth(p);
    EXPECT_NEAR(s.value, 3 - p.x + 2 * p.y + 4 * p.z, 1e-5);
    EXPECT_NEAR(Norm(s.gradient - Vec3d{-1, 2, 4}), 0, 2e-5);
    const SmoothSample b = bowl.SampleSmooth(p);
    EXPECT_NEAR(b.value, p.x * p.x + p.y * p.z + 2 * kGrid.spacing * kGrid.spacing / 8, 1e-5);
    EXPECT_NEAR(Norm(b.gradient - Vec3d{2 * p.x, p.z, p.y}), 0, 2e-5);
    EXPECT_NEAR(b.xx, 2, 1e-3);
    EXPECT_NEAR(b.yz, 1, 1e-3);
    EXPECT_NEAR(std::abs(b.yy) + std::abs(b.zz) + std::abs(b.xy) + std::abs(b.xz), 0, 1e-3);
  }
}

TEST(ScalarField, DerivativesAreThoseOfWhatIsSampled) {
  const ScalarField field = Fill(kGrid, [](const Vec3d& p) {
    return std::sin(3 * p.x) * std::cos(2 * p.y) + std::sin(4 * p.z + p.x);
  });
  Rng rng(4);
  const double h = 1e-4;
  const Vec3d ex{h, 0, 0}, ey{0, h, 0}, ez{0, 0, h};
  int checked = 0;
  for (int k = 0; k < 400; ++k) {
    const Vec3d p = Inside(kGrid, &rng, 0.01);
    // Away from the joints, where the second derivatives (linear: the first ones) jump.
    const Vec3d u = CellOf(kGrid, p).u;
    const auto off_joint = [](double w) {
      return w > 0.01 && w < 0.99 && std::abs(w - 0.5) > 0.01;
    };
    if (!off_joint(u.x) || !off_joint(u.y) || !off_joint(u.z)) continue;
    ++checked;
    const auto slope = [&](auto value) {
      return Vec3d{value(p + ex) - value(p - ex), value(p + ey) - value(p - ey),
                   value(p + ez) - value(p - ez)} /
             (2 * h);
    };
    const auto linear = [&](const Vec3d& q) { return field.Sample(q); };
    const auto smooth = [&](const Vec3d& q) { return field.SampleSmooth(q).value; };
    const SmoothSample s = field.SampleSmooth(p);
    EXPECT_LT(Norm(field.SampleLinear(p).gradient - slope(linear)), 1e-6);
    EXPECT_LT(Norm(s.gradient - slope(smooth)), 1e-6);
    const auto gx = [&](const Vec3d& q) { return field.SampleSmooth(q).gradient.x; };
    const auto gy = [&](const Vec3d& q) { return field.SampleSmooth(q).gradient.y; };
    const auto gz = [&](const Vec3d& q) { return field.SampleSmooth(q).gradient.z; };
    EXPECT_LT(Norm(slope(gx) - Vec3d{s.xx, s.xy, s.xz}), 1e-6);
    EXPECT_LT(Norm(slope(gy) - Vec3d{s.xy, s.yy, s.yz}), 1e-6);
    EXPECT_LT(Norm(slope(gz) - Vec3d{s.xz, s.yz, s.zz}), 1e-6);
  }
  EXPECT_GT(checked, 200);
}

TEST(ScalarField, TheSmoothGradientDoesNotJump) {
  const ScalarField field = Fill(kGrid, [](const Vec3d& p) { return std::sin(5 * p.x) * p.y; });
  const double step = 1e-7;
  for (int i = 1; i < 16; ++i) {  // joints halfway between nodes
    const Vec3d p{kGrid.low.x + 0.5 * i * kGrid.spacing, 2.6, 1.1}, e{step, 0, 0};
    EXPECT_LT(Norm(field.SampleSmooth(p - e).gradient - field.SampleSmooth(p + e).gradient), 1e-4);
  }
}

TEST(ScalarField, ContinuesBeyondTheGrid) {
  const ScalarField field = Fill(kGrid, [](const Vec3d& p) { return p.x + 10 * p.y + 100 * p.z; });
  const Vec3d high = kGrid.High();
  EXPECT_DOUBLE_EQ(field.Sample(high + Vec3d{1, 2, 3}), field.Sample(high));
  EXPECT_DOUBLE_EQ(field.Sample({-50, 2.5, 1}), field.Sample({-1, 2.5, 1}));
  EXPECT_DOUBLE_EQ(field.SampleSmooth({-50, 2.5, 1}).value, field.SampleSmooth({-1, 2.5, 1}).value);
}

TEST(ScalarField, AFlatFieldHasNoSlopeAcross) {
  const Grid flat{{0, 0, 5}, 0.5, 6, 6, 1};
  const ScalarField field = Fill(flat, [](const Vec3d& p) { return 2 * p.x - p.y; });
  for (const double z : {-3.0, 5.0, 9.0}) {
    EXPECT_NEAR(field.Sample({1.1, 1.3, z}), 0.9, 1e-6);
    EXPECT_LT(Norm(field.SampleLinear({1.1, 1.3, z}).gradient - Vec3d{2, -1, 0}), 1e-5);
    EXPECT_LT(Norm(field.SampleSmooth({1.1, 1.3, z}).gradient - Vec3d{2, -1, 0}), 1e-5);
  }
}

}  // namespace
}  // namespace flocklift
