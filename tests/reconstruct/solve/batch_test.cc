// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/batch.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reconstruct/cost_functions/body_image.h"
#include "reconstruct/solve/batch_model.h"
#include "reconstruct/solve/batch_start.h"
#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

using namespace internal;  // NOLINT: the oracle minimises the method's own residuals

// All residuals of one bird as one cost function of its path, its own and the flock's unknowns;
// losses are taken into the residuals: r' = sign(r) sqrt(2 rho(r)).
class BirdCost : public ceres::CostFunction {
 public:
  BirdCost(const BatchModel& model, const Bird& bird) : model_(model), bird_(bird) {
    int count = 0;
    ForEachRow(model, bird, StartOfShared(model), false,
               [&count](Term, const ResidualRow&) { ++count; });
    set_num_residuals(count);
    *mutable_parameter_block_sizes() = {bird.unknowns(), kOwnUnknowns, model.shared()};
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    Bird bird = bird_;
    std::copy_n(blocks[0], bird.unknowns(), bird.path.begin());
    std::copy_n(blocks[1], kOwnUnknowns, bird.own.begin());
    const Eigen::VectorXd shared = Eigen::Map<const Eigen::VectorXd>(blocks[2], model_.shared());
    const int sizes[] = {bird.unknowns(), kOwnUnknowns, model_.shared()};
    if (jacobians != nullptr) {
      for (int b = 0; b < 3; ++b) {
        if (jacobians[b] != nullptr) std::fill_n(jacobians[b], num_residuals() * sizes[b], 0.0);
      }
    }
    int r = 0;
    ForEachRow(model_, bird, shared, true, [&](Term term, const ResidualRow& row) {
      const double cost = RobustCost(term, row.residual);
      residuals[r] = std::copysign(std::sqrt(2 * cost), row.residual);
      const double slope =
          residuals[r] == 0 ? 1 : RobustWeight(term, row.residual) * row.residual / residuals[r];
      if (jacobians != nullptr) {
        for (int a = 0; a < 12 && row.first + a < sizes[0]; ++a) {
          if (jacobians[0] != nullptr) {
            jacobians[0][r * sizes[0] + row.first + a] =
                slope * row.path[static_cast<std::size_t>(a)];
          }
        }
        for (int a = 0; a < row.border_count; ++a) {
          const auto [index, derivative] = row.border[static_cast<std::size_t>(a)];
          const int block = index < kOwnUnknowns ? 1 : 2;
          const int column = block == 1 ? index : index - kOwnUnknowns;
          if (jacobians[block] != nullptr) {
            jacobians[block][r * sizes[block] + column] += slope * derivative;
          }
        }
      }
      ++r;
    });
    return true;
  }

 private:
  BatchModel model_;
  Bird bird_;
};

struct Scene {
  FlockSpec flock{.count = 4, .frames = 60};
  Camera camera = WatchingCamera();
  Segments segments =
      MakeSegments({}, Observe(flock, {}, CirclingFlock(flock), camera), camera, flock.fps);
  Knowledge knowledge;

  Scene() {
    knowledge.speed = Uncertain{10, 1};
    knowledge.wingspan = Uncertain{0.6, 0.03};
    knowledge.up_in_cam = camera.cam_from_world->rotation * Vec3d{0, 0, 1};
  }
};

// Calls fn(box, heading, wings, depth, image) for every box of animals that lean into their turns
// by the share `lean`: axes of the world, and what makes images of such.
template <typename Function>
void ForEachView(const FlockSpec& spec, const Trajectories& truth, const Camera& camera,
                 double lean, Tracks* tracks, const Function& fn) {
  for (std::size_t i = 0; i < truth.trajectories.size(); ++i) {
    const std::vector<TrajectoryPoint>& points = truth.trajectories[i].points;
    std::vector<Detection>& boxes = tracks->tracklets[i].detections;
    ASSERT_EQ(points.size(), boxes.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const std::size_t m = std::clamp<std::size_t>(k, 1, points.size() - 2);
      const Vec3d before = points[m - 1].position, here = points[m].position;
      const Vec3d after = points[m + 1].position;
      const Vec3d curve = spec.fps * spec.fps / 9.81 * (after - 2.0 * here + before);
      const Vec3d heading = Normalized(after - before);
      const Vec3d wings = Normalized(Cross(heading, Vec3d{0, 0, 1} + lean * curve));
      const Rigid3d cam_from_world = camera.CamFromWorld(points[k].frame);
      const Vec3d x = cam_from_world * points[k].position;
      fn(&boxes[k].box, heading, wings, x.z, [&](const Vec3d& axis) {
        const Vec3d a = cam_from_world.rotation * axis;
        return Vec2d{a.x - x.x / x.z * a.z, a.y - x.y / x.z * a.z};
      });
    }
  }
}

// Gives every box the size of a body with extents 1, 0.6 and 0.4 along wings, trunk and up.
void SizeBoxesByView(const FlockSpec& spec, const Trajectories& truth, const Camera& camera,
                     double lean, Tracks* tracks) {
  ForEachView(
      spec, truth, camera, lean, tracks,
      [&](Box* box, const Vec3d& trunk, const Vec3d& wings, double depth, const auto& image) {
        double squares = 0;
        for (const Vec3d& axis : {wings, 0.6 * trunk, 0.4 * Cross(wings, trunk)}) {
          const Vec2d a = image(axis);
          squares += a.x * a.x + a.y * a.y;
        }
        const double size = camera.intrinsics.fx * spec.wingspan / depth * std::sqrt(squares);
        *box = Box::Around(box->Center(), 0.8 * size, 0.6 * size);
      });
}

// Birds on circles of 12 m at 10 m/s: a coordinated turn banks them by 40 degrees.
TEST(Batch, FindsHowFarAnimalsLean) {
  Scene scene;
  scene.flock.count = 12;
  scene.flock.frames = 150;
  const Trajectories truth = CirclingFlock(scene.flock);
  for (const double lean : {0.0, 1.0}) {
    Tracks seen = Observe(scene.flock, {}, truth, scene.camera);
    SizeBoxesByView(scene.flock, truth, scene.camera, lean, &seen);
    const BatchResult result =
        SolveBatch({}, scene.knowledge, MakeSegments({}, seen, scene.camera, scene.flock.fps),
                   scene.flock.fps, 1, {});
    EXPECT_LT(result.report.lean.sd, 0.25);
    EXPECT_NEAR(result.report.lean.mean, lean, 0.3);
  }
}

// Keeps the size of every box and gives it the form of a body (body_image.h).
void FormBoxesByView(const FlockSpec& spec, const Trajectories& truth, const Camera& camera,
                     double lean, Tracks* tracks) {
  const BodyImage body(BodyImage::Kind::kBox, {.length = 0.5, .amplitude = 0.7});
  ForEachView(spec, truth, camera, lean, tracks,
              [&](Box* place, const Vec3d& g, const Vec3d& s, double, const auto& image) {
                const double e = body.Ellipticity(image(g), image(s), image(Cross(s, g))).x;
                Box& box = *place;
                const double size = std::hypot(box.width, box.height);
                box = Box::Around(box.Center(), size * std::sqrt((1 + e) / 2),
                                  size * std::sqrt((1 - e) / 2));
              });
}

// Sizes say nothing of it here: they do not go with the view.
TEST(Batch, SeesHowFarAnimalsLeanByTheFormOfBoxes) {
  Scene scene;
  scene.flock.count = 12;
  scene.flock.frames = 150;
  const Trajectories truth = CirclingFlock(scene.flock);
  double found[2];
  for (const int lean : {0, 1}) {
    Tracks seen = Observe(scene.flock, {}, truth, scene.camera);
    FormBoxesByView(scene.flock, truth, scene.camera, lean, &seen);
    found[lean] =
        SolveBatch({}, scene.knowledge, MakeSegments({}, seen, scene.camera, scene.flock.fps),
                   scene.flock.fps, 1, {})
            .report.lean.mean;
  }
  EXPECT_GT(found[1], found[0] + 0.4);
}

// Boxes of bodies, seen along the rays to them or, in weak perspective, along the optical axis.
TEST(Batch, SaysWhetherBodiesAreInPerspective) {
  Scene scene;
  scene.flock.count = 12;
  scene.flock.frames = 150;
  const Trajectories truth = CirclingFlock(scene.flock);
  const BodyImage body(BodyImage::Kind::kBox, {.length = 0.5, .amplitude = 0.7});
  const Rigid3d cam_from_world = *scene.camera.cam_from_world;
  for (const bool weak : {false, true}) {
    Tracks seen = Observe(scene.flock, {}, truth, scene.camera);
    ForEachView(scene.flock, truth, scene.camera, 1, &seen,
                [&](Box* box, const Vec3d& g, const Vec3d& s, double depth, const auto& in_place) {
                  const auto image = [&](const Vec3d& axis) {
                    return weak ? ImageOf(cam_from_world.rotation * axis, Vec2d{}) : in_place(axis);
                  };
                  const Vec2d a = image(g), b = image(s), c = image(Cross(s, g));
                  const double size = scene.camera.intrinsics.fx * scene.flock.wingspan / depth *
                                      std::exp(body.LogSize(a, b, c));
                  const double e = body.Ellipticity(a, b, c).x;
                  *box = Box::Around(box->Center(), size * std::sqrt((1 + e) / 2),
                                     size * std::sqrt((1 - e) / 2));
                });
    const BatchResult result =
        SolveBatch({}, scene.knowledge, MakeSegments({}, seen, scene.camera, scene.flock.fps),
                   scene.flock.fps, 1, {});
    EXPECT_EQ(result.report.weak_perspective, weak);
    EXPECT_LT(result.report.stiff_boxes, 0.1);
  }
}

// The arrow solver finds the minimum that Ceres finds for the same residuals.
TEST(Batch, ReachesTheMinimumOfCeres) {
  const Scene scene;
  BatchOptions options;
  options.estimate = false;
  options.max_iterations = 200;
  const BatchResult result =
      SolveBatch(options, scene.knowledge, scene.segments, scene.flock.fps, 1, {});

  const ScaleGuess guess = GuessScale(scene.knowledge, scene.segments);
  const BatchModel model =
      MakeModel(options, scene.knowledge, scene.segments, guess, std::nullopt, scene.flock.fps);
  std::vector<Bird> birds;
  for (const Segment& segment : scene.segments.segments) {
    birds.push_back(StartBird(model, scene.knowledge, guess, segment, scene.flock.fps, 1));
  }
  Eigen::VectorXd shared = StartOfShared(model);
  // The flock's own priors are quadratic: a square root of their matrix, about their minimum.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(model.shared(), model.shared());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(model.shared());
  const double offset = SharedPriors(model, shared, &matrix, &gradient);
  ASSERT_LT(gradient.norm(), 1e-9);  // the start is the minimum
  const Eigen::MatrixXd root = matrix.llt().matrixU();
  ceres::Problem problem;
  for (Bird& bird : birds) {
    problem.AddResidualBlock(new BirdCost(model, bird), nullptr, bird.path.data(), bird.own.data(),
                             shared.data());
  }
  problem.AddResidualBlock(new ceres::NormalPrior(root, shared), nullptr, shared.data());
  ceres::Solver::Options solver;
  solver.max_num_iterations = 2000;
  solver.function_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-12;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.initial_trust_region_radius = 1e8;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);

  EXPECT_NEAR(result.report.final_cost, summary.final_cost + offset, 1e-4 * summary.final_cost);
  for (std::size_t i = 0; i < birds.size(); ++i) {
    for (std::size_t k = 0; k < birds[i].places.size(); k += 7) {
      const Bird::Place& place = birds[i].places[k];
      double log_depth = 0;
      for (int a = 0; a < 4; ++a) {
        log_depth += place.weights[static_cast<std::size_t>(a)] *
                     birds[i].path[static_cast<std::size_t>(3 * (place.interval + a) + 2)];
      }
      EXPECT_NEAR(std::log(result.paths[i][k].position_in_cam.z), log_depth, 3e-3);
    }
  }
}

TEST(Batch, CostFallsAndResidualsAreAsAssumed) {
  const Scene scene;
  const BatchResult result = SolveBatch({}, scene.knowledge, scene.segments, 30, 1, {});
  EXPECT_TRUE(result.report.converged);
  EXPECT_LT(result.report.final_cost, result.report.initial_cost);
  EXPECT_GT(result.report.scale_sd, 0.03);
  EXPECT_LT(result.report.scale_sd, 0.12);
  for (const TermStatistics& term : result.report.terms) {
    if (term.name == "reprojection") {
      EXPECT_NEAR(term.rms, 1, 0.15);
      EXPECT_LT(term.outliers, 0.02);
      EXPECT_EQ(term.count, 4 * 60 * 2);
    }
  }
}

TEST(Batch, NothingIsNoFault) {
  Knowledge knowledge;
  knowledge.speed = Uncertain{10, 1};
  EXPECT_TRUE(SolveBatch({}, knowledge, {}, 30, 1, {}).paths.empty());
}

}  // namespace
}  // namespace flocklift
