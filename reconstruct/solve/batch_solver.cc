// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/batch_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <utility>

namespace flocklift::internal {
namespace {

constexpr double kLeastDamping = 1e-9, kMostDamping = 1e9;

double Damped(double damping, bool moved) {
  return std::clamp(damping * (moved ? 0.2 : 8), kLeastDamping, kMostDamping);
}

}  // namespace

double BatchSolver::Cost() {
  ForEachBird([this](std::size_t i) {
    work_[i].cost = CostOf(state_.model, state_.birds[i], state_.shared);
  });
  double cost = SharedPriors(state_.model, state_.shared, nullptr, nullptr);
  for (const Workspace& w : work_) cost += w.cost;
  return cost;
}

Eigen::MatrixXd BatchSolver::Linearize() {
  Assemble();
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
  Reduce(0, &matrix, &gradient);
  return matrix.llt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

void BatchSolver::Assemble() {
  ForEachBird([this](std::size_t i) { Assemble(state_.birds[i], &work_[i].system); });
}

void BatchSolver::Assemble(const Bird& bird, ArrowSystem* system) const {
  system->SetZero();
  ForEachRow(state_.model, bird, state_.shared, true, [system](Term term, const ResidualRow& row) {
    system->Add(row, RobustWeight(term, row.residual));
  });
}

double BatchSolver::MinimizeAlone(std::size_t i, int max_iterations, Bird* bird) {
  constexpr double kStandstill = 0.01;  // of log likelihood
  Workspace& w = work_[i];
  w.candidate = *bird;
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(state_.model.shared());
  double damping = 1e-3;
  double cost = CostOf(state_.model, *bird, state_.shared);
  for (int iteration = 0; iteration < max_iterations && damping < kMostDamping; ++iteration) {
    Assemble(*bird, &w.system);
    if (!Reduce(damping, &w)) return cost;
    const bool moved = Step(still, state_.shared, *bird, &w) && w.candidate_cost < cost;
    damping = Damped(damping, moved);
    if (!moved) continue;
    const double fall = cost - w.candidate_cost;
    std::swap(bird->path, w.candidate.path);
    bird->own = w.candidate.own;
    cost = w.candidate_cost;
    if (fall < kStandstill) break;
  }
  return cost;
}

void BatchSolver::Reduce(double damping_factor, Eigen::MatrixXd* matrix,
                         Eigen::VectorXd* gradient) {
  const int size = state_.model.shared();
  ForEachBird([&](std::size_t i) {
    Workspace& w = work_[i];
    for (double damping = damping_factor * w.damping; !Reduce(damping, &w);
         damping = std::max(10 * damping, 1e-9)) {
      if (damping > kMostDamping) {  // nothing is known of this animal: leave it out
        w.system.SetIdentity();
      }
    }
  });
  matrix->setZero(size, size);
  gradient->setZero(size);
  SharedPriors(state_.model, state_.shared, matrix, gradient);
  for (const Workspace& w : work_) {  // in this order at any number of threads
    *matrix += w.shared_matrix;
    *gradient += w.shared_gradient;
  }
}

bool BatchSolver::Reduce(double damping, Workspace* w) const {
  const int size = state_.model.shared();
  w->shared_matrix.setZero(size, size);
  w->shared_gradient.setZero(size);
  return w->system.Reduce(damping, &w->shared_matrix, &w->shared_gradient);
}

bool BatchSolver::Step(const Eigen::VectorXd& shared_step, const Eigen::VectorXd& shared,
                       const Bird& bird, Workspace* w) const {
  const Eigen::VectorXd step = w->system.BackSubstitute(shared_step);
  w->candidate_cost = std::numeric_limits<double>::infinity();
  if (!step.allFinite()) return false;
  w->candidate.path = bird.path;
  w->candidate.own = bird.own;
  for (int k = 0; k < bird.unknowns(); ++k) w->candidate.path[k] += step[k];
  for (int k = 0; k < kOwnUnknowns; ++k) w->candidate.own[k] += step[bird.unknowns() + k];
  w->candidate_cost = CostOf(state_.model, w->candidate, shared);
  return w->candidate_cost < std::numeric_limits<double>::infinity();
}

bool BatchSolver::Minimize(int max_iterations, const Standstill& standstill, int* iterations) {
  constexpr double kRounding = 1e-8;  // of the cost
  double cost = Cost();
  for (std::size_t i = 0; i < work_.size(); ++i) work_[i].candidate = state_.birds[i];
  int still = 0;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    state_.model.CountIteration();
    ++*iterations;
    Assemble();
    Eigen::MatrixXd matrix;
    Eigen::VectorXd gradient;
    Reduce(1, &matrix, &gradient);
    const Eigen::VectorXd step = -matrix.llt().solve(gradient);
    if (!step.allFinite()) return false;
    // A step of the flock's unknowns that is too far for the model is halved; each animal takes
    // its own part of the step only when that helps it.
    bool accepted = false;
    for (double share = 1; share > 0.02 && !accepted; share *= 0.4) {
      const Eigen::VectorXd shared_step = share * step;
      const Eigen::VectorXd shared = state_.shared + shared_step;
      ForEachBird([&](std::size_t i) {
        Workspace& w = work_[i];
        const Bird& bird = state_.birds[i];
        w.moved = Step(shared_step, shared, bird, &w);
        if (!(w.candidate_cost < w.cost)) {
          const double stay = CostOf(state_.model, bird, shared);
          if (!(w.candidate_cost < stay)) {
            w.moved = false;
            w.candidate_cost = stay;
          }
        }
      });
      double candidate = SharedPriors(state_.model, shared, nullptr, nullptr);
      for (const Workspace& w : work_) candidate += w.candidate_cost;
      if (!(candidate < cost)) continue;
      accepted = true;
      state_.shared = shared;
      for (std::size_t i = 0; i < work_.size(); ++i) {
        Workspace& w = work_[i];
        if (w.moved) {
          std::swap(state_.birds[i].path, w.candidate.path);
          state_.birds[i].own = w.candidate.own;
        }
        w.cost = w.candidate_cost;
        w.damping = Damped(w.damping, w.moved);
      }
      still = cost - candidate < standstill.fall + kRounding * cost ? still + 1 : 0;
      cost = candidate;
    }
    if (!accepted) {
      ++still;
      for (Workspace& w : work_) w.damping = std::min(w.damping * 10, kMostDamping);
    }
    if (still >= standstill.times) return true;
  }
  return false;
}

}  // namespace flocklift::internal
