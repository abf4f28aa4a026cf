// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

Silhouette RandomSilhouette(Rng* rng, double size) {
  Silhouette s;
  double top = rng->Uniform(0, 5);
  for (int k = 0; k < 4; ++k) {
    const double bottom = top + rng->Uniform(0.05, 0.5 * size);
    Trapezoid t{top, bottom, 0, 0, 0, 0};
    t.left_at_top = rng->Uniform(0, size);
    t.left_at_bottom = rng->Uniform(0, size);
    t.right_at_top = t.left_at_top + rng->Uniform(0, size);
    t.right_at_bottom = t.left_at_bottom + rng->Uniform(0, size);
    s.trapezoids.push_back(t);
    top = bottom;
  }
  return s;
}

// What pixel (u, v) sees, from many points around it.
double SampledShare(const Silhouette& s, int u, int v) {
  constexpr int kSamples = 60;
  double sum = 0;
  for (int j = 0; j < kSamples; ++j) {
    const double dy = 2 * (j + 0.5) / kSamples - 1;
    for (const Trapezoid& t : s.trapezoids) {
      if (v + dy < t.top || v + dy >= t.bottom) continue;
      const double share = (v + dy - t.top) / (t.bottom - t.top);
      const double left = t.left_at_top + share * (t.left_at_bottom - t.left_at_top);
      const double right = t.right_at_top + share * (t.right_at_bottom - t.right_at_top);
      for (int i = 0; i < kSamples; ++i) {
        const double dx = 2 * (i + 0.5) / kSamples - 1;
        if (u + dx >= left && u + dx < right) sum += (1 - std::abs(dx)) * (1 - std::abs(dy));
      }
    }
  }
  return 4 * sum / (kSamples * kSamples);
}

TEST(CoverageTest, AgreesWithSampling) {
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Rng rng(3, trial);
    const Silhouette s = RandomSilhouette(&rng, trial % 2 == 0 ? 1.5 : 12);
    CoverageMask mask(BoundsOf(s), 100, 100);
    ASSERT_FALSE(mask.empty());
    mask.Add(s, 1);
    mask.Finish();
    for (int v = 0; v < mask.height(); ++v) {
      for (int u = 0; u < mask.width(); ++u) {
        EXPECT_NEAR(mask.Row(v)[u], SampledShare(s, mask.left() + u, mask.top() + v), 0.035)
            << trial << " pixel " << u << " " << v;
      }
    }
  }
}

TEST(CoverageTest, AreaAndCentroidAreKept) {
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    Rng rng(4, trial);
    const Silhouette s = RandomSilhouette(&rng, 8);
    const SilhouetteMoments m = MomentsOf(s);
    CoverageMask mask(BoundsOf(s), 100, 100);
    mask.Add(s, 1);
    mask.Finish();
    double area = 0, x = 0, y = 0;
    for (int v = 0; v < mask.height(); ++v) {
      for (int u = 0; u < mask.width(); ++u) {
        area += mask.Row(v)[u];
        x += mask.Row(v)[u] * (mask.left() + u);
        y += mask.Row(v)[u] * (mask.top() + v);
      }
    }
    EXPECT_NEAR(area, m.area, 1e-5 * m.area);
    EXPECT_NEAR(x / area, m.centroid.x, 1e-4);
    EXPECT_NEAR(y / area, m.centroid.y, 0.01);
  }
}

// Far smaller than a pixel, at many places in it.
TEST(CoverageTest, ASpeckKeepsItsPlace) {
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    Rng rng(9, trial);
    Silhouette s{{{0, 0.3, -0.15, -0.15, 0.15, 0.15}}};
    s.Shift({rng.Uniform(5, 6), rng.Uniform(5, 6)});
    const SilhouetteMoments m = MomentsOf(s);
    CoverageMask mask(BoundsOf(s), 20, 20);
    mask.Add(s, 1);
    mask.Finish();
    double area = 0, x = 0, y = 0;
    for (int v = 0; v < mask.height(); ++v) {
      for (int u = 0; u < mask.width(); ++u) {
        area += mask.Row(v)[u];
        x += mask.Row(v)[u] * (mask.left() + u);
        y += mask.Row(v)[u] * (mask.top() + v);
      }
    }
    EXPECT_NEAR(area, 0.09, 1e-6);
    EXPECT_NEAR(x / area, m.centroid.x, 1e-4);
    EXPECT_NEAR(y / area, m.centroid.y, 1e-4);
  }
}

TEST(CoverageTest, WhatLeavesTheImageIsCutOffExactly) {
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Rng rng(6, trial);
    Silhouette s = RandomSilhouette(&rng, 12);
    s.Shift({rng.Uniform(-12, 6), rng.Uniform(-8, 6)});
    constexpr int kWidth = 9, kHeight = 7;
    CoverageMask mask(BoundsOf(s), kWidth, kHeight);
    EXPECT_LE(mask.left() + mask.width(), kWidth);
    EXPECT_LE(mask.top() + mask.height(), kHeight);
    mask.Add(s, 1);
    mask.Finish();
    for (int v = 0; v < mask.height(); ++v) {
      for (int u = 0; u < mask.width(); ++u) {
        EXPECT_NEAR(mask.Row(v)[u], SampledShare(s, mask.left() + u, mask.top() + v), 0.035);
      }
    }
  }
  const Silhouette far{{{500, 510, 500, 500, 510, 510}}};
  EXPECT_TRUE(CoverageMask(BoundsOf(far), 100, 100).empty());
}

TEST(CoverageTest, ExposuresAddUp) {
  const Silhouette a{{{0, 6, 0, 0, 4, 4}}};
  const Silhouette b{{{0, 6, 7, 7, 11, 11}}};
  CoverageMask mask({0, 0, 11, 6}, 20, 20);
  mask.Add(a, 0.25);
  mask.Add(b, 0.75);
  mask.Finish();
  const float* row = mask.Row(3 - mask.top());
  EXPECT_NEAR(row[2 - mask.left()], 0.25, 1e-6);
  EXPECT_NEAR(row[9 - mask.left()], 0.75, 1e-6);
}

TEST(CoverageTest, InsideIsFullAndFarOutsideIsEmpty) {
  const Silhouette s{{{2, 10, 3, 3, 12, 12}}};
  CoverageMask mask(BoundsOf(s), 100, 100);
  mask.Add(s, 1);
  mask.Finish();
  EXPECT_NEAR(mask.Row(6 - mask.top())[7 - mask.left()], 1, 1e-6);
  EXPECT_NEAR(mask.Row(6 - mask.top())[3 - mask.left()], 0.5, 1e-6);
  EXPECT_NEAR(mask.Row(2 - mask.top())[3 - mask.left()], 0.25, 0.01);
}

}  // namespace
}  // namespace flocklift
