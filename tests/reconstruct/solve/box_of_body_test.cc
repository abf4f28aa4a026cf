// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/box_of_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

namespace flocklift::internal {
namespace {

// One bird in the middle of the picture, whose velocity over depth is `w`, seen at two knots.
struct Seen {
  BatchModel model;
  std::vector<Bird> birds;
  Eigen::VectorXd shared = Eigen::VectorXd::Zero(kFlockScalars);

  Seen(const Vec3d& w, const std::optional<Vec3d>& up_in_cam, double log_depth) {
    model.up_in_cam = up_in_cam;
    shared[kLogTrunk] = std::log(0.25);
    shared[kLogUp] = std::log(0.1);
    Bird bird;
    bird.knots = 2;
    bird.softening = 1e-6;
    for (int control = 0; control < bird.knots + 2; ++control) {
      const double t = model.knot_interval * (control - 1);
      for (const double value : {w.x * t, w.y * t, log_depth + w.z * t}) bird.path.push_back(value);
    }
    bird.size.assign(2, 0.0);
    bird.curve.assign(2, Vec3d{});
    birds.push_back(bird);
  }

  double Ratio(const BodyShape& body) const { return Ratio(body, *model.up_in_cam); }
  double Ratio(const BodyShape& body, const Vec3d& up) const {
    return BoxRatio(body, up, model, birds, shared, 2);
  }
  double Sd() const { return ExpectedBoxRatio(model, birds, shared, 0).sd; }
};

constexpr Vec3d kAhead{0, 0, 1}, kUpwards{0, -1, 0};  // camera axes

// Q of size.h by hand, from the shares of the wings and of the trunk that are seen.
double ExtentOf(double across, double along) {
  return 1.5 * (across + 0.25 * along + 0.1 * (2 - along - across)) / (1 + 0.25 + 0.1);
}
// 3 % of the mean over all rolls, 1/2 from the side and from below, are mixed into the wings'
// share.
double Mixed(double across) { return (across + 0.03 * 0.5) / 1.03; }

TEST(BoxOfBodyTest, FromBelowItIsSpanAndLength) {
  const Seen seen({0.1, 0, 0}, kAhead, 4);  // the camera looks up
  EXPECT_NEAR(seen.Ratio({.length = 0.5, .amplitude = 0}),
              0.5 * std::log(1.25 / ExtentOf(Mixed(1), 1)), 1e-6);
}

TEST(BoxOfBodyTest, FromTheSideItIsLengthAndWhatTheWingbeatAdds) {
  const Seen seen({0.1, 0, 0}, kUpwards, 4);
  EXPECT_NEAR(seen.Ratio({.length = 0.5, .amplitude = 0}),
              0.5 * std::log((0.25 + 0.01) / ExtentOf(Mixed(0), 1)), 1e-6);
  EXPECT_GT(seen.Ratio({.length = 0.5, .amplitude = 0.8}),
            seen.Ratio({.length = 0.5, .amplitude = 0}) + 0.05);
}

// A box about a line of length 1 has that diagonal at any roll, but for its thickness.
TEST(BoxOfBodyTest, WingsOfUnknownRollSpanAsMuchFromTheFront) {
  const Seen seen({0, 0, -0.1}, std::nullopt, 4);
  for (const Vec3d& up : {kUpwards, Vec3d{1, 0, 0}, Vec3d{0.6, 0.8, 0}}) {
    EXPECT_NEAR(seen.Ratio({.length = 0.5, .amplitude = 0}, up), 0.5 * std::log(1 / ExtentOf(1, 0)),
                0.01);
  }
}

// Birds that fly across are seen from the side or from below, nobody knows which, and all alike.
TEST(BoxOfBodyTest, AnUnknownUpIsUnknownToAllBirdsAlike) {
  Seen flock({0.1, 0, 0}, std::nullopt, 4);
  const double one = flock.Sd();
  const BodyShape usual;
  const double apart = flock.Ratio(usual, kAhead) - flock.Ratio(usual, kUpwards);
  EXPECT_GT(one, 0.25 * apart);
  EXPECT_LT(one, 0.75 * apart);
  EXPECT_GT(one, 1.5 * Seen({0.1, 0, 0}, kAhead, 4).Sd());
  for (int bird = 0; bird < 20; ++bird) flock.birds.push_back(flock.birds.front());
  EXPECT_NEAR(flock.Sd(), one, 1e-12);
}

// Headings of all directions are seen from everywhere, wherever up is.
TEST(BoxOfBodyTest, ManyHeadingsMakeUpMatterLess) {
  Seen flock({0.1, 0, 0}, std::nullopt, 4);
  const double one = flock.Sd();
  for (const Vec3d& w : {Vec3d{0, 0.1, 0}, Vec3d{0, 0, 0.1}}) {
    flock.birds.push_back(Seen(w, std::nullopt, 4).birds.front());
  }
  EXPECT_LT(flock.Sd(), 0.8 * one);
}

// As far as sizes follow bodies at all.
TEST(BoxOfBodyTest, InWeakPerspectiveBodiesLookTheSameBesideTheAxis) {
  const BodyShape body{.length = 0.45, .amplitude = 0.6};
  const auto ratio = [&body](double x, double share) {
    Seen seen({0.1, 0.03, 0}, kUpwards, 4);
    for (std::size_t k = 0; k < seen.birds[0].path.size(); k += 3) seen.birds[0].path[k] += x;
    seen.model.body.weak_perspective = true;
    seen.model.body.share = share;
    return seen.Ratio(body);
  };
  EXPECT_NEAR(ratio(0.5, 1), ratio(0, 1), 1e-9);
  EXPECT_GT(std::abs(ratio(0.5, 0) - ratio(0, 0)), 0.02);
}

TEST(BoxOfBodyTest, KnowsNothingOfTheScale) {
  const BodyShape body{.length = 0.45, .amplitude = 0.6};
  const Seen near({0.1, 0.03, -0.05}, kUpwards, 2), far({0.1, 0.03, -0.05}, kUpwards, 5);
  EXPECT_NEAR(near.Ratio(body), far.Ratio(body), 1e-9);
}

// From the front the length does not matter, and wings that are raised are as high as they are less
// wide.
TEST(BoxOfBodyTest, IsSurestFromTheFront) {
  const Seen front({0, 0, -0.1}, kUpwards, 4), side({0.1, 0, 0}, kUpwards, 4);
  EXPECT_GT(side.Sd(), front.Sd() + 0.02);
}

TEST(BoxOfBodyTest, WithoutASizeThereIsNothingToSay) {
  Seen seen({0.1, 0, 0}, kAhead, 4);
  seen.birds[0].size.assign(2, std::nullopt);
  EXPECT_EQ(seen.Ratio({}), 0);
}

}  // namespace
}  // namespace flocklift::internal
