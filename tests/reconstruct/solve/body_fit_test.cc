// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/body_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "reconstruct/cost_functions/path.h"
#include "reconstruct/solve/curves.h"

namespace flocklift::internal {
namespace {

using Kind = BodyImage::Kind;
constexpr Uncertain kLeanBefore{0.7, 0.5};

// Birds that wheel before the camera, 10 m/s in circles of 12 m, each around its own height.
struct Wheeling {
  BatchModel model;
  std::vector<Bird> birds;

  explicit Wheeling(double distance = 50) {
    model.up_in_cam = Vec3d{0, -1, 0};
    constexpr int kBirds = 6, kKnots = 60;
    for (int i = 0; i < kBirds; ++i) {
      Bird bird;
      bird.knots = kKnots;
      bird.form.resize(kKnots);
      bird.curve.resize(kKnots);
      for (int control = 0; control < kKnots + 2; ++control) {
        const double turn = i + 10.0 / 12 * model.knot_interval * (control - 1);
        const double z = distance + 12 * std::sin(turn);
        bird.path.insert(bird.path.end(),
                         {12 * std::cos(turn) / z, (2.0 * i - 12) / z, std::log(z)});
      }
      birds.push_back(bird);
    }
    UpdateCurves(model, &birds);
  }

  // What such bodies look like, with errors that alternate.
  void Show(const BodyImage& body, double lean, double error, double perspective = 1) {
    for (Bird& bird : birds) {
      for (int knot = 0; knot < bird.knots; ++knot) {
        const std::size_t k = static_cast<std::size_t>(knot);
        const PathState<double> q = StateAtKnot(&bird.path[3 * k], 1 / model.knot_interval);
        const Vec3d g = Normalized(VelocityOverDepth(q, {}));
        const Vec3d s = Normalized(Cross(g, *model.up_in_cam + lean * bird.curve[k]));
        const double x = perspective * q.x, y = perspective * q.y;
        const auto image = [x, y](const Vec3d& a) { return Vec2d{a.x - x * a.z, a.y - y * a.z}; };
        const Vec2d e = body.Ellipticity(image(g), image(s), image(Cross(s, g)));
        const double off = knot % 2 == 0 ? error : -error;
        bird.form[k] = Vec2d{e.x + off, e.y - off};
      }
    }
  }
};

TEST(BodyFit, FindsBodiesAndHowFarTheyLean) {
  for (const double lean : {0.0, 0.6, 1.0}) {
    Wheeling flock;
    flock.Show(BodyImage(Kind::kSilhouette, {.trunk = 0.2, .amplitude = 0.6}), lean, 0.1);
    ASSERT_TRUE(FitBody(true, kLeanBefore, flock.birds, &flock.model));
    const FlockBody& body = flock.model.body;
    EXPECT_EQ(body.image.kind(), Kind::kSilhouette);
    EXPECT_NEAR(body.lean, lean, 0.03);
    EXPECT_NEAR(flock.model.lean.mean, lean, 0.03);
    EXPECT_LT(flock.model.lean.sd, 0.15);
    EXPECT_NEAR(body.image.shape().trunk, 0.2, 0.02);
    EXPECT_NEAR(body.image.shape().amplitude, 0.6, 0.03);
    EXPECT_LT(body.amplitude_sd, FlockBody{}.amplitude_sd);
    EXPECT_EQ(body.length_sd, FlockBody{}.length_sd);  // shapes tell nothing of it
  }
}

TEST(BodyFit, BoxesTellOfLengthsToo) {
  Wheeling flock;
  flock.Show(BodyImage(Kind::kBox, {.length = 0.42, .amplitude = 0.6}), 1, 0.05);
  ASSERT_TRUE(FitBody(false, kLeanBefore, flock.birds, &flock.model));
  EXPECT_NEAR(flock.model.body.image.shape().length, 0.42, 0.02);
  EXPECT_NEAR(flock.model.body.image.shape().amplitude, 0.6, 0.05);
  EXPECT_NEAR(flock.model.body.lean, 1, 0.1);
  EXPECT_LT(flock.model.body.length_sd, FlockBody{}.length_sd);
}

TEST(BodyFit, FormsTellWhetherBodiesAreInPerspective) {
  for (const Kind kind : {Kind::kSilhouette, Kind::kBox}) {
    for (const double perspective : {1.0, 0.0}) {
      Wheeling flock;
      flock.Show(BodyImage(kind, {.amplitude = 0.6}), 1, 0.05, perspective);
      ASSERT_TRUE(FitBody(kind == Kind::kSilhouette, kLeanBefore, flock.birds, &flock.model));
      EXPECT_EQ(flock.model.body.perspective, perspective);
      EXPECT_NEAR(flock.model.body.image.shape().amplitude, 0.6, 0.05);
    }
  }
}

// Long lenses show next to nothing of it.
TEST(BodyFit, IsInPerspectiveWhereNothingTells) {
  Wheeling flock(5000);
  flock.Show(BodyImage(Kind::kBox, {.amplitude = 0.6}), 1, 0.05, 0);
  ASSERT_TRUE(FitBody(false, kLeanBefore, flock.birds, &flock.model));
  EXPECT_EQ(flock.model.body.perspective, 1);
}

TEST(BodyFit, AFewWrongFormsDoNotMatter) {
  Wheeling flock;
  flock.Show(BodyImage(Kind::kSilhouette, {.trunk = 0.2, .amplitude = 0.6}), 1, 0.05);
  for (Bird& bird : flock.birds) {
    for (std::size_t k = 10; k < 15; ++k) bird.form[k] = Vec2d{-1, 0};
  }
  ASSERT_TRUE(FitBody(true, kLeanBefore, flock.birds, &flock.model));
  EXPECT_NEAR(flock.model.body.lean, 1, 0.1);
}

// Who flies straight shows nothing of a lean.
TEST(BodyFit, WithoutTurnsALeanIsAsUnknownAsBefore) {
  Wheeling flock;
  for (Bird& bird : flock.birds) bird.curve.assign(bird.curve.size(), Vec3d{});
  flock.Show(BodyImage(Kind::kSilhouette, {.trunk = 0.2, .amplitude = 0.6}), 0, 0.1);
  ASSERT_TRUE(FitBody(true, kLeanBefore, flock.birds, &flock.model));
  EXPECT_NEAR(flock.model.lean.mean, kLeanBefore.mean, 1e-3);
  EXPECT_NEAR(flock.model.lean.sd, kLeanBefore.sd, 1e-3);
}

TEST(BodyFit, WithoutFormsOrGravityThereIsNothingToSee) {
  Wheeling flock;
  EXPECT_FALSE(FitBody(true, kLeanBefore, flock.birds, &flock.model));
  flock.Show(BodyImage(Kind::kSilhouette, {}), 1, 0);
  flock.model.up_in_cam.reset();
  EXPECT_FALSE(FitBody(true, kLeanBefore, flock.birds, &flock.model));
  EXPECT_EQ(flock.model.body.image.kind(), FlockBody{}.image.kind());
}

}  // namespace
}  // namespace flocklift::internal
