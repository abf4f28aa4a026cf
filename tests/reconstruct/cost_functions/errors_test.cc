// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "reconstruct/cost_functions/acceleration.h"
#include "reconstruct/cost_functions/erratic_flight.h"
#include "reconstruct/cost_functions/level_flight.h"
#include "reconstruct/cost_functions/markov.h"
#include "reconstruct/cost_functions/reprojection.h"
#include "reconstruct/cost_functions/size.h"
#include "reconstruct/cost_functions/speed.h"
#include "simulate/core/rng.h"
#include "tests/reconstruct/cost_functions/gradient_check.h"

namespace flocklift {
namespace {

// Control points, 1 s apart, of the knot state (x, y, log z) with the given slopes and no curves.
std::array<double, 9> Straight(Vec3d here, Vec3d slope) {
  return {here.x - slope.x, here.y - slope.y, here.z - slope.z, here.x,          here.y,
          here.z,           here.x + slope.x, here.y + slope.y, here.z + slope.z};
}

TEST(ReprojectionError, ByHand) {
  ReprojectionError error{SplineWeights(0.5), {0.1, 0.2}, 0.01};
  std::array<double, 12> c{};
  for (int a = 0; a < 4; ++a) {
    c[3 * a] = 0.12;
    c[3 * a + 1] = 0.17;
  }
  double r[2];
  error(c.data(), r);
  EXPECT_NEAR(r[0], 2, 1e-12);
  EXPECT_NEAR(r[1], -3, 1e-12);
  ExpectGradient<2, 12>([&](const auto* p, auto* e) { error(p, e); }, c);
}

TEST(MarkovProcess, ByHand) {
  const MarkovProcess process{2, 0.5};
  EXPECT_NEAR(process.Correlation(0.5), std::exp(-1), 1e-15);
  EXPECT_NEAR(process.StepSd(0.6), 1.6, 1e-15);
}

// At depth e^3 on the axis: a straight path in (x, y, log z) with slope 0.2 in log z accelerates
// along z by 0.2^2 z, whatever z is.
TEST(AccelerationError, DoesNotKnowTheScale) {
  const AccelerationError error{.rate = 1, .reference_depth = 10};
  for (double l : {1.0, 3.0}) {
    double e[3];
    error(Straight({0, 0, l}, {0, 0, 0.2}).data(), e);
    EXPECT_NEAR(e[0], 0, 1e-12);
    EXPECT_NEAR(e[2], 10 * 0.04, 1e-12);
  }
}

// 10 m away, image speed 0.3 and 0.4 per second: 5 m/s.
TEST(SpeedError, ByHand) {
  const SpeedError error{.rate = 1, .softening = 1e-6};
  double e;
  error(Straight({0, 0, std::log(10.0)}, {0.3, 0.4, 0}).data(), std::log(2.0), &e);
  EXPECT_NEAR(e, std::log(2.5), 1e-9);
  error(Straight({0, 0, std::log(20.0)}, {0.3, 0.4, 0}).data(), std::log(4.0), &e);
  EXPECT_NEAR(e, std::log(2.5), 1e-9);  // twice as far and twice as fast is the same
}

TEST(SpeedError, StandstillIsFinite) {
  const SpeedError error{.rate = 1, .softening = 1e-3};
  double e;
  error(Straight({0.1, 0.1, 2}, {}).data(), 0.0, &e);
  EXPECT_NEAR(e, 2 + std::log(1e-3), 1e-9);
}

// 10 m away on the axis, 3 m/s across and 2 m/s away, of an animal whose mean is 5 m/s.
TEST(ErraticFlightError, ByHand) {
  const ErraticFlightError error{.rate = 1, .softening = 1e-6};
  double e[2];
  error(Straight({0, 0, std::log(10.0)}, {0.3, 0, 0.2}).data(), std::log(5.0), e);
  EXPECT_NEAR(e[0], std::log(0.6) + 0.409, 1e-9);
  EXPECT_NEAR(e[1], 0.4, 1e-9);
  std::array<double, 10> c{};
  std::copy_n(SomePath().begin(), 9, c.begin());
  c[9] = std::log(10.0);
  ExpectGradient<2, 10>([&](const auto* p, auto* r) { error(p, p[9], r); }, c);
}

// Velocities that are normal in every direction have errors of mean 0 and these sds.
TEST(ErraticFlightError, KnowsWhatIsUsual) {
  const ErraticFlightError error{.rate = 1, .softening = 1e-6};
  const double sd = 0.02, mean_speed = 10 * sd * std::sqrt(8 / std::numbers::pi);
  Rng rng(3);
  constexpr int kCount = 20000;
  double sum[2] = {}, squares[2] = {};
  for (int k = 0; k < kCount; ++k) {
    const Vec3d w{sd * rng.Normal(), sd * rng.Normal(), sd * rng.Normal()};
    double e[2];
    error(Straight({0, 0, std::log(10.0)}, w).data(), std::log(mean_speed), e);
    for (int a = 0; a < 2; ++a) {
      sum[a] += e[a] / kCount;
      squares[a] += e[a] * e[a] / kCount;
    }
  }
  EXPECT_NEAR(sum[0], 0, 0.02);
  EXPECT_NEAR(sum[1], 0, 0.02);
  EXPECT_NEAR(std::sqrt(squares[0]), kLogAcrossSd, 0.02);
  EXPECT_NEAR(std::sqrt(squares[1]), kAlongSd, 0.02);
}

// Up is -y of the camera; 0.3 across and -0.4 up per second climbs with sine 0.8.
TEST(LevelFlightError, ByHand) {
  const LevelFlightError error{.rate = 1, .softening = 1e-6, .up_in_cam = {0, -1, 0}};
  double e;
  error(Straight({0, 0, 2}, {0.3, -0.4, 0}).data(), &e);
  EXPECT_NEAR(e, 0.8, 1e-9);
}

// On the axis, up = -y. Seen from behind (flying away) the wings lie across: Q = 1 + up; flying
// across, they point at the camera: Q = trunk + up; both over the mean 2/3 (1 + trunk + up).
TEST(SizeError, ViewsByHand) {
  const double trunk = 0.25, up = 0.1, log_size = -4;
  const SizeError error{.rate = 1,
                        .softening = 1e-9,
                        .log_size = log_size,
                        .log_wingspan = std::log(0.7),
                        .up_in_cam = Vec3d{0, -1, 0}};
  const double l = std::log(30.0), mean = 2.0 / 3 * (1 + trunk + up);
  double away, across;
  const double bias = 0.03, ratio = -0.1;
  error(Straight({0, 0, l}, {0, 0, 0.3}).data(), bias, ratio, std::log(trunk), std::log(up), 1.0,
        &away);
  error(Straight({0, 0, l}, {0.3, 0, 0}).data(), bias, ratio, std::log(trunk), std::log(up), 1.0,
        &across);
  const double base = log_size - (std::log(0.7 / 30) + bias + ratio);
  EXPECT_NEAR(away, base - 0.5 * std::log((1 + up) / mean), 1e-9);
  // The small share of views along the vertical, see the certainty of the side.
  EXPECT_NEAR(across, base - 0.5 * std::log((trunk + up) / mean), 0.05);
  EXPECT_GT(across - away, 0.4);
}

// Flying across with the acceleration of gravity towards the camera, a body banks by 45 degrees:
// its wings are seen foreshortened by the root of 2. Without a lean they point at the camera.
TEST(SizeError, BodiesLeanIntoTurns) {
  const double trunk = 0.25, up = 0.1, mean = 2.0 / 3 * (1 + trunk + up);
  const SizeError error{.rate = 1,
                        .softening = 1e-9,
                        .log_size = 0,
                        .log_wingspan = 0,
                        .up_in_cam = Vec3d{0, -1, 0},
                        .curve = {0, 0, -1}};
  const auto seen = [&](double lean) {
    double e;
    error(Straight({0, 0, 0}, {0.3, 0, 0}).data(), 0.0, 0.0, std::log(trunk), std::log(up), lean,
          &e);
    return std::exp(-2 * e) * mean;  // Q without the mean
  };
  EXPECT_NEAR(seen(1), 0.5 + trunk + 0.5 * up, 0.01);
  EXPECT_NEAR(seen(-1), 0.5 + trunk + 0.5 * up, 0.01);
  EXPECT_NEAR(seen(0), trunk + up, 0.02);
}

// A body with three equal axes looks the same from everywhere (on the optical axis).
TEST(SizeError, ABallHasNoView) {
  const SizeError error{.rate = 1,
                        .softening = 1e-9,
                        .log_size = -3,
                        .log_wingspan = 0,
                        .up_in_cam = Vec3d{0, -1, 0}};
  for (const Vec3d& slope : {Vec3d{0.3, 0, 0}, Vec3d{0.1, -0.2, 0.1}, Vec3d{0, 0, -0.3}}) {
    double e;
    error(Straight({0, 0, 2.5}, slope).data(), 0.0, 0.0, 0.0, 0.0, 0.0, &e);
    EXPECT_NEAR(e, -3 + 2.5, 1e-9);
  }
}

// A bird that flies straight away, wings across. In perspective, off the axis, its trunk is seen
// from the side too; in weak perspective it looks as it does on the axis.
TEST(SizeError, WeakPerspectiveLooksAlongTheAxisEverywhere) {
  const double trunk = 0.25, up = 0.1, mean = 2.0 / 3 * (1 + trunk + up), x = 0.6;
  const auto seen = [&](double perspective) {
    const SizeError error{.rate = 1,
                          .softening = 1e-9,
                          .log_size = 0,
                          .log_wingspan = 0,
                          .up_in_cam = Vec3d{0, -1, 0},
                          .perspective = perspective};
    double e;
    // Along the axis: the ray moves towards the middle as it gets farther.
    error(Straight({x, 0, 0}, {-0.3 * x, 0, 0.3}).data(), 0.0, 0.0, std::log(trunk), std::log(up),
          0.0, &e);
    return std::exp(-2 * e) * mean;  // Q without the mean
  };
  EXPECT_NEAR(seen(1), 1 + trunk * x * x + up, 0.02);
  EXPECT_NEAR(seen(0), 1 + up, 0.02);
}

TEST(SizeError, WithoutGravityWingsAreAnywhereAcross) {
  SizeError error{
      .rate = 1, .softening = 1e-9, .log_size = 0, .log_wingspan = 0, .up_in_cam = std::nullopt};
  double away, across;
  error(Straight({0, 0, 0}, {0, 0, 0.3}).data(), 0.0, 0.0, std::log(0.25), std::log(0.1), 0.0,
        &away);
  error(Straight({0, 0, 0}, {0.3, 0, 0}).data(), 0.0, 0.0, std::log(0.25), std::log(0.1), 0.0,
        &across);
  const double mean = 2.0 / 3 * 1.35;
  EXPECT_NEAR(away, -0.5 * std::log(1.1 / mean), 1e-9);
  EXPECT_NEAR(across, -0.5 * std::log((0.5 * 1.1 + 0.25) / mean), 1e-9);
}

// With a body, trunk and up as usual, the size is that of the body's image.
TEST(SizeError, FollowsTheImageOfABody) {
  const BodyImage body(BodyImage::Kind::kBox, {.length = 0.5, .amplitude = 0});
  const SizeError error{.rate = 1,
                        .softening = 1e-9,
                        .log_size = -4,
                        .log_wingspan = std::log(0.7),
                        .up_in_cam = Vec3d{0, -1, 0},
                        .body = &body,
                        .body_share = 1};
  double away, across;
  const double l = std::log(30.0), base = -4 - std::log(0.7 / 30);
  error(Straight({0, 0, l}, {0, 0, 0.3}).data(), 0.0, 0.0, kUsualLogTrunk, kUsualLogUp, 0.0, &away);
  error(Straight({0, 0, l}, {0.3, 0, 0}).data(), 0.0, 0.0, kUsualLogTrunk, kUsualLogUp, 0.0,
        &across);
  EXPECT_NEAR(away, base - 0.5 * std::log(1 + 0.01), 0.02);  // sides are certain to 3 %
  EXPECT_NEAR(across, base - 0.5 * std::log(0.25 + 0.01), 0.03);
}

TEST(Errors, DerivativesMatchNumericDifferences) {
  const auto path = SomePath();
  for (const CameraMotion& camera :
       {CameraMotion{},
        CameraMotion{.moves = true, .velocity = {2, -1, 3}, .acceleration = {0.5, 1, -2}}}) {
    const AccelerationError acceleration{.rate = 10, .reference_depth = 45, .camera = camera};
    ExpectGradient<3, 9>([&](const auto* p, auto* e) { acceleration(p, e); }, path);
    const LevelFlightError level{.rate = 10,
                                 .softening = 0.01,
                                 .up_in_cam = {0.1, -0.9, std::sqrt(1 - 0.82)},
                                 .camera = camera};
    ExpectGradient<1, 9>([&](const auto* p, auto* e) { level(p, e); }, path);

    const SpeedError speed{.rate = 10, .softening = 0.01, .camera = camera};
    std::array<double, 10> with_speed{};
    std::copy(path.begin(), path.end(), with_speed.begin());
    with_speed[9] = 2.3;
    ExpectGradient<1, 10>([&](const auto* p, auto* e) { speed(p, p[9], e); }, with_speed);

    for (const bool gravity : {true, false}) {
      SizeError size{
          .rate = 10, .softening = 0.01, .log_size = -4, .log_wingspan = -0.4, .up_in_cam = {}};
      if (gravity) size.up_in_cam = level.up_in_cam;
      size.camera = camera;
      if (gravity) size.curve = {0.3, -0.1, 0.4};
      std::array<double, 14> with_size{};
      std::copy(path.begin(), path.end(), with_size.begin());
      with_size[9] = 0.02;
      with_size[10] = -0.1;
      with_size[11] = -1.1;
      with_size[12] = -1.9;
      with_size[13] = 0.7;
      const BodyImage body(BodyImage::Kind::kSilhouette, {});  // a box has corners
      size.body = &body;
      for (const double share : {0.0, 0.7}) {
        size.body_share = share;
        for (const double perspective : {1.0, 0.0}) {
          size.perspective = perspective;
          ExpectGradient<1, 14>(
              [&](const auto* p, auto* e) { size(p, p[9], p[10], p[11], p[12], p[13], e); },
              with_size);
        }
      }
    }
  }
}

}  // namespace
}  // namespace flocklift
