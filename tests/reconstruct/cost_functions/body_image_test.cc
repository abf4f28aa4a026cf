// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/cost_functions/body_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "tests/reconstruct/cost_functions/gradient_check.h"

namespace flocklift {
namespace {

using Kind = BodyImage::Kind;

// Images of g, s, u of a body on the optical axis, its heading turned by `yaw` out of the picture
// plane, rolled by `roll` about it.
struct Axes {
  Vec2d g, s, u;

  Axes(double yaw, double roll) {
    const Vec3d heading{std::cos(yaw), 0, std::sin(yaw)};
    const Vec3d level{-std::sin(yaw), 0, std::cos(yaw)}, upright{0, -1, 0};
    const Vec3d side = std::cos(roll) * level + std::sin(roll) * upright;
    const Vec3d up = Cross(side, heading);
    g = {heading.x, heading.y};
    s = {side.x, side.y};
    u = {up.x, up.y};
  }
};

constexpr BodyShape kGliding{.length = 0.5, .trunk = 0.3, .amplitude = 0};

TEST(BodyImage, GlidingByHand) {
  const BodyImage box(Kind::kBox, kGliding), silhouette(Kind::kSilhouette, kGliding);
  const Axes front(std::numbers::pi / 2, 0), side(0, 0), below(0, std::numbers::pi / 2);
  EXPECT_NEAR(box.LogSize(front.g, front.s, front.u), 0.5 * std::log(1 + 0.01), 1e-12);
  EXPECT_NEAR(box.LogSize(side.g, side.s, side.u), 0.5 * std::log(0.25 + 0.01), 1e-12);
  EXPECT_NEAR(box.LogSize(below.g, below.s, below.u), 0.5 * std::log(1.25), 1e-12);
  EXPECT_NEAR(box.Ellipticity(below.g, below.s, below.u).x, (0.25 - 1) / 1.25, 1e-12);
  EXPECT_NEAR(silhouette.LogSize(front.g, front.s, front.u), 0, 1e-12);
  EXPECT_NEAR(silhouette.LogSize(side.g, side.s, side.u), 0.5 * std::log(0.3), 1e-12);
  EXPECT_NEAR(silhouette.Ellipticity(side.g, side.s, side.u).x, 1, 1e-12);
}

// Wings banked by 45 degrees, seen from the front, stretch along a diagonal: of moments
// (a b; b c) = (1 1; 1 1) / 2 or with b < 0.
TEST(BodyImage, BankedWingsStretchAlongTheDiagonal) {
  const BodyImage silhouette(Kind::kSilhouette, kGliding);
  const Axes left(std::numbers::pi / 2, std::numbers::pi / 4);
  const Axes right(std::numbers::pi / 2, -std::numbers::pi / 4);
  const Vec2d e = silhouette.Ellipticity(left.g, left.s, left.u);
  EXPECT_NEAR(e.x, 0, 1e-12);
  EXPECT_NEAR(std::abs(e.y), 1, 1e-12);
  EXPECT_NEAR(silhouette.Ellipticity(right.g, right.s, right.u).y, -e.y, 1e-12);
}

// The box of the four points of the documentation, at many phases.
TEST(BodyImage, IsTheMeanOverTheWingbeat) {
  const BodyShape shape{.length = 0.45, .trunk = 0.3, .amplitude = 0.9};
  const BodyImage box(Kind::kBox, shape);
  for (const Axes& axes : {Axes(0.3, 0.2), Axes(1.2, -0.5), Axes(-0.8, 0.9)}) {
    double log_size = 0, ellipticity = 0;
    constexpr int kPhases = 360;
    for (int k = 0; k < kPhases; ++k) {
      const double f = shape.amplitude * std::sin(2 * std::numbers::pi * (k + 0.5) / kPhases);
      const auto extent = [&](double g, double s, double u) {
        const double tip = 0.5 * std::cos(f) * s, raised = 0.5 * std::sin(f) * u;
        const double nose = 0.5 * shape.length * g;
        const auto [least, most] = std::minmax({raised + tip, raised - tip, nose, -nose});
        return std::max(most - least, 0.1);
      };
      const double w = extent(axes.g.x, axes.s.x, axes.u.x);
      const double h = extent(axes.g.y, axes.s.y, axes.u.y);
      log_size += std::log(std::hypot(w, h)) / kPhases;
      ellipticity += (w * w - h * h) / (w * w + h * h) / kPhases;
    }
    EXPECT_NEAR(box.LogSize(axes.g, axes.s, axes.u), log_size, 0.01);
    EXPECT_NEAR(box.Ellipticity(axes.g, axes.s, axes.u).x, ellipticity, 0.02);
  }
}

TEST(BodyImage, DerivativesMatchNumericDifferences) {
  const BodyShape shape{.length = 0.45, .trunk = 0.3, .amplitude = 0.7};
  for (const Kind kind : {Kind::kBox, Kind::kSilhouette}) {
    const BodyImage body(kind, shape);
    for (const std::array<double, 6>& images :
         {std::array{0.8, -0.2, 0.3, 0.7, -0.5, 0.4}, std::array{0.1, 0.3, -0.9, 0.2, 0.1, 0.8}}) {
      ExpectGradient<1, 6>(
          [&](const auto* p, auto* e) {
            using T = std::remove_cvref_t<decltype(*p)>;
            e[0] = body.LogSize(Vec2<T>{p[0], p[1]}, Vec2<T>{p[2], p[3]}, Vec2<T>{p[4], p[5]});
          },
          images);
    }
  }
}

}  // namespace
}  // namespace flocklift
