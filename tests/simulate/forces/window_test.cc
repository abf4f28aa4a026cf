// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/window.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// (window, closed window, step) of (distance, radius, taper).
struct Windows {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return {TaperWindow(T(in[0] * in[0]), in[1], in[2]),
            ClosedTaperWindow(T(in[0] * in[0]), in[1], in[2]), SoftStep(T(in[0] - in[1]), in[2])};
  }
};
struct Extremes {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return {SoftMax(in[0], in[1], in[2]), SoftMin(in[0], in[1], in[2]), T(0.0)};
  }
};

TEST(Window, ByHand) {
  const auto at = [](double r, double taper) {
    return Evaluate<double>(Windows{}, std::array{r, 2.0, taper});
  };
  ExpectNear(at(2.0, 1.0), {0.5, 0.5, 0.5}, 1e-9);
  ExpectNear(at(1.5, 1.0), {1, 1, 0}, 1e-9);
  ExpectNear(at(2.5, 1.0), {0, 0, 1}, 1e-9);
  // u = 1/4: u^2 (3 - 2u) = 0.15625.
  ExpectNear(at(2.25, 1.0), {0.15625, 0.15625, 0.84375}, 1e-9);
}

TEST(Window, TaperZeroIsThePublishedCutOff) {
  const auto at = [](double r) { return Evaluate<double>(Windows{}, std::array{r, 2.0, 0.0}); };
  EXPECT_EQ(at(1.999), (Vec3d{1, 1, 0}));
  EXPECT_EQ(at(2.0), (Vec3d{0, 1, 0}));  // [r < radius], [r <= radius], [r > radius]
  EXPECT_EQ(at(2.001), (Vec3d{0, 0, 1}));
  EXPECT_EQ(at(0.0), (Vec3d{1, 1, 0}));
  for (const double r : {0.0, 1.0, 1.999, 2.0, 2.001, 5.0}) {
    EXPECT_EQ(TaperWindow(r * r, 2.0, HardEdge{}), TaperWindow(r * r, 2.0, 0.0));
    EXPECT_EQ(SoftStep(r - 2.0, HardEdge{}), SoftStep(r - 2.0, 0.0));
  }
}

TEST(Window, IsMonotoneWithoutSteps) {
  double last = 1;
  for (int k = 0; k <= 4000; ++k) {
    const double r = 0.001 * k;
    const double w = TaperWindow(r * r, 2.0, 0.7);
    EXPECT_LE(w, last);
    EXPECT_LT(last - w, 0.0025);
    last = w;
  }
}

TEST(Window, ScalarsAgree) {
  for (const double taper : {0.0, 0.3, 4.0}) {
    for (const double r : {0.0, 0.5, 1.9, 2.1, 7.0}) {
      ExpectScalarsAgree(Windows{}, std::array{r, 2.0, taper});
      ExpectScalarsAgree(Extremes{}, std::array{r, 2.0, taper});
    }
  }
}

TEST(Window, Gradient) {
  for (const double r : {1.9, 2.1, 2.3}) {
    ExpectGradientMatches(Windows{}, std::array{r, 2.0, 1.0});
    ExpectGradientMatches(Extremes{}, std::array{r, 2.0, 1.0});
  }
}

TEST(SoftMax, ByHand) {
  EXPECT_EQ(SoftMax(1.0, 3.0, 0.0), 3.0);
  EXPECT_EQ(SoftMin(1.0, 3.0, 0.0), 1.0);
  EXPECT_EQ(SoftMax(1.0, 3.0, 2.0), 3.0);  // they differ by the taper: no rounding left
  EXPECT_EQ(SoftMax(3.0, 3.0, 2.0), 3.5);  // in the corner: taper / 4 above
  EXPECT_EQ(SoftMin(3.0, 3.0, 2.0), 2.5);
  EXPECT_EQ(SoftMax(3.0, 2.0, 2.0), 3.125);
}

}  // namespace
}  // namespace flocklift
