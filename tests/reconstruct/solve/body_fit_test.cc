// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/body_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "reconstruct/cost_functions/path.h"
#include "reconstruct/solve/curves.h"
#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

using Kind = BodyImage::Kind;
constexpr Uncertain kLeanBefore{0.7, 0.5};

Segments FormsOf(Kind kind, bool camera_turns = false) {
  Segments segments;
  segments.has_shapes = kind == Kind::kSilhouette;
  segments.camera_turns = camera_turns;
  return segments;
}

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
  void Show(const BodyImage& body, double lean, double error, bool weak_perspective = false) {
    for (Bird& bird : birds) {
      for (int knot = 0; knot < bird.knots; ++knot) {
        const std::size_t k = static_cast<std::size_t>(knot);
        const PathState<double> q = StateAtKnot(&bird.path[3 * k], 1 / model.knot_interval);
        const Vec3d g = Normalized(VelocityOverDepth(q, {}));
        const Vec3d s = Normalized(Cross(g, *model.up_in_cam + lean * bird.curve[k]));
        const Vec2d ray = weak_perspective ? Vec2d{} : Vec2d{q.x, q.y};
        const Vec2d e =
            body.Ellipticity(ImageOf(g, ray), ImageOf(s, ray), ImageOf(Cross(s, g), ray));
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
    ASSERT_TRUE(FitBody(FormsOf(Kind::kSilhouette), kLeanBefore, flock.birds, &flock.model));
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
  ASSERT_TRUE(FitBody(FormsOf(Kind::kBox), kLeanBefore, flock.birds, &flock.model));
  EXPECT_NEAR(flock.model.body.image.shape().length, 0.42, 0.02);
  EXPECT_NEAR(flock.model.body.image.shape().amplitude, 0.6, 0.05);
  EXPECT_NEAR(flock.model.body.lean, 1, 0.1);
  EXPECT_LT(flock.model.body.length_sd, FlockBody{}.length_sd);
}

TEST(BodyFit, FormsTellWhetherBodiesAreInPerspective) {
  for (const Kind kind : {Kind::kSilhouette, Kind::kBox}) {
    for (const bool weak : {false, true}) {
      Wheeling flock;
      flock.Show(BodyImage(kind, {.amplitude = 0.6}), 1, 0.05, weak);
      ASSERT_TRUE(FitBody(FormsOf(kind), kLeanBefore, flock.birds, &flock.model));
      EXPECT_EQ(flock.model.body.weak_perspective, weak);
      EXPECT_NEAR(flock.model.body.image.shape().amplitude, 0.6, 0.05);
    }
  }
}

// Pictures do not keep the axis of a camera that turns.
TEST(BodyFit, ATurningCameraShowsPerspective) {
  Wheeling flock;
  flock.Show(BodyImage(Kind::kSilhouette, {.amplitude = 0.6}), 1, 0.05, true);
  ASSERT_TRUE(FitBody(FormsOf(Kind::kSilhouette, true), kLeanBefore, flock.birds, &flock.model));
  EXPECT_FALSE(flock.model.body.weak_perspective);
}

// Every animal beats its wings in its own way and is measured with an error that stays.
TEST(BodyFit, BodiesUnlikeTheModelStayInPerspective) {
  for (int seed = 1; seed <= 5; ++seed) {
    Wheeling flock;
    for (std::size_t i = 0; i < flock.birds.size(); ++i) {
      Rng rng(static_cast<std::uint64_t>(seed), i);
      Wheeling own;
      own.Show(BodyImage(Kind::kBox, {.length = 0.5 + 0.08 * rng.Normal(),
                                      .amplitude = 0.8 + 0.25 * rng.Normal()}),
               0.8 + 0.3 * rng.Normal(), 0.05);
      const double error = 0.1 * rng.Normal();
      flock.birds[i].form = own.birds[i].form;
      for (auto& form : flock.birds[i].form) form->x += error;
    }
    ASSERT_TRUE(FitBody(FormsOf(Kind::kBox), kLeanBefore, flock.birds, &flock.model));
    EXPECT_FALSE(flock.model.body.weak_perspective) << seed;
  }
}

// Long lenses show next to nothing of it.
TEST(BodyFit, IsInPerspectiveWhereNothingTells) {
  Wheeling flock(5000);
  flock.Show(BodyImage(Kind::kBox, {.amplitude = 0.6}), 1, 0.05, true);
  ASSERT_TRUE(FitBody(FormsOf(Kind::kBox), kLeanBefore, flock.birds, &flock.model));
  EXPECT_FALSE(flock.model.body.weak_perspective);
}

TEST(BodyFit, AFewWrongFormsDoNotMatter) {
  Wheeling flock;
  flock.Show(BodyImage(Kind::kSilhouette, {.trunk = 0.2, .amplitude = 0.6}), 1, 0.05);
  for (Bird& bird : flock.birds) {
    for (std::size_t k = 10; k < 15; ++k) bird.form[k] = Vec2d{-1, 0};
  }
  ASSERT_TRUE(FitBody(FormsOf(Kind::kSilhouette), kLeanBefore, flock.birds, &flock.model));
  EXPECT_NEAR(flock.model.body.lean, 1, 0.1);
}

// Who flies straight shows nothing of a lean.
TEST(BodyFit, WithoutTurnsALeanIsAsUnknownAsBefore) {
  Wheeling flock;
  for (Bird& bird : flock.birds) bird.curve.assign(bird.curve.size(), Vec3d{});
  flock.Show(BodyImage(Kind::kSilhouette, {.trunk = 0.2, .amplitude = 0.6}), 0, 0.1);
  ASSERT_TRUE(FitBody(FormsOf(Kind::kSilhouette), kLeanBefore, flock.birds, &flock.model));
  EXPECT_NEAR(flock.model.lean.mean, kLeanBefore.mean, 1e-3);
  EXPECT_NEAR(flock.model.lean.sd, kLeanBefore.sd, 1e-3);
}

TEST(BodyFit, WithoutFormsOrGravityThereIsNothingToSee) {
  Wheeling flock;
  EXPECT_FALSE(FitBody(FormsOf(Kind::kSilhouette), kLeanBefore, flock.birds, &flock.model));
  flock.Show(BodyImage(Kind::kSilhouette, {}), 1, 0);
  flock.model.up_in_cam.reset();
  EXPECT_FALSE(FitBody(FormsOf(Kind::kSilhouette), kLeanBefore, flock.birds, &flock.model));
  EXPECT_EQ(flock.model.body.image.kind(), FlockBody{}.image.kind());
}

}  // namespace
}  // namespace flocklift::internal
