// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lin's objective by Levenberg and Marquardt. Its absolute values and distances are no squares:
// w |r| is the loss w (sqrt(r^2 + a^2) - a) for a small a, which is lowered in steps so that the
// first ones see a smooth function.

#include <ceres/ceres.h>

#include <array>
#include <memory>

#include "reconstruct/solve/lin_objective.h"

namespace flocklift::internal {
namespace {

// Of depths in metres; a step between frames is some 0.3 m.
constexpr std::array<double, 3> kRoundings = {1e-1, 1e-2, 1e-3};

// Ceres' cost is half the loss of r^2: SoftLOne(a) of it is a (sqrt(r^2 + a^2) - a).
std::unique_ptr<ceres::LossFunction> AbsoluteLoss(double weight, double rounding) {
  return std::make_unique<ceres::ScaledLoss>(new ceres::SoftLOneLoss(rounding), weight / rounding,
                                             ceres::TAKE_OWNERSHIP);
}

void AddAnimal(const CobylaOptions& options, double fps, const std::vector<LinAnimal>& animals,
               const Vec3d& target, std::size_t n, double rounding,
               const std::vector<double*>& blocks, ceres::Problem* problem) {
  const LinAnimal& a = animals[n];
  const bool has_past = a.solved_frames >= 2;
  const double expected = has_past ? Norm(a.last - a.before_last) : options.lambda_speed / fps;
  problem->AddResidualBlock(new ceres::AutoDiffCostFunction<LinStepError, 1, 1>(
                                new LinStepError{a.ray, a.last, expected}),
                            AbsoluteLoss(has_past ? options.lambda_t : 1, rounding).release(),
                            blocks[n]);
  if (!has_past) return;
  ceres::LossFunction* loss = AbsoluteLoss(options.lambda_f, rounding).release();
  if (!options.current_frame) {
    problem->AddResidualBlock(
        new ceres::AutoDiffCostFunction<LinTargetError, 3, 1>(new LinTargetError{a.ray, target}),
        loss, blocks[n]);
    return;
  }
  constexpr int kAtOnce = 8;  // derivatives of one evaluation
  auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<LinMovingTargetError, kAtOnce>>(
      new LinMovingTargetError{&options, &animals, n});
  for (std::size_t i = 0; i < animals.size(); ++i) cost->AddParameterBlock(1);
  cost->SetNumResiduals(3);
  problem->AddResidualBlock(cost.release(), loss, blocks);
}

}  // namespace

double MinimizeLinByCeres(const CobylaOptions& options, double fps,
                          const std::vector<LinAnimal>& animals, std::vector<double>* depths,
                          bool* exhausted) {
  const std::vector<Vec3d> targets = LinTargetsOfLastFrame(options, animals);
  std::vector<double*> blocks;
  for (double& depth : *depths) blocks.push_back(&depth);
  for (const double rounding : kRoundings) {
    ceres::Problem problem;
    for (double* block : blocks) {
      problem.AddParameterBlock(block, 1);
      problem.SetParameterLowerBound(block, 0, options.near);
      problem.SetParameterUpperBound(block, 0, options.far);
    }
    for (std::size_t n = 0; n < animals.size(); ++n) {
      AddAnimal(options, fps, animals, targets[n], n, rounding, blocks, &problem);
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    solver.logging_type = ceres::SILENT;
    solver.max_num_iterations = 50;
    solver.parameter_tolerance = 0.1 * options.tolerance;
    solver.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    *exhausted = summary.termination_type != ceres::CONVERGENCE;
  }
  return LinObjective(options, fps, animals, *depths);
}

}  // namespace flocklift::internal
