// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Damped Gauss-Newton for the batch method's problem (batch_problem.h): every animal is eliminated
// by itself (arrow_system.h), the flock's unknowns are solved for, and each animal takes its own
// part of the step only when that helps it. The same at any number of threads.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_SOLVER_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_SOLVER_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "reconstruct/solve/arrow_system.h"
#include "reconstruct/solve/batch_problem.h"
#include "simulate/core/parallel_for.h"

namespace flocklift::internal {

// Everything that moves while solving.
struct BatchState {
  BatchModel model;
  std::vector<Bird> birds;
  Eigen::VectorXd shared;
};

// What one animal needs for a step.
struct Workspace {
  ArrowSystem system;
  double damping = 1e-3;  // Levenberg's, of this animal
  double cost = 0;
  Eigen::MatrixXd shared_matrix;
  Eigen::VectorXd shared_gradient;
  Bird candidate;
  double candidate_cost = 0;
  bool moved = false;
};

class BatchSolver {
 public:
  BatchSolver(BatchState* state, int threads) : state_(*state), pool_(threads) {
    for (const Bird& bird : state_.birds) {
      work_.push_back({.system = ArrowSystem(bird.unknowns(), kOwnUnknowns, state_.model.shared()),
                       .shared_matrix = {},
                       .shared_gradient = {},
                       .candidate = bird});
    }
  }

  // When the cost stands still: when it falls by less than `fall` so many times on end.
  struct Standstill {
    double fall = 0;
    int times = 1;
  };

  // Until the cost stands still. Returns whether it did; counts the iterations.
  bool Minimize(int max_iterations, const Standstill& standstill, int* iterations);

  // One animal by itself, the flock's unknowns as they are, until its cost stands still. Returns
  // the cost.
  double MinimizeAlone(std::size_t i, int max_iterations, Bird* bird);

  double Cost();

  // Normal equations at the present state, undamped. Returns the covariance of the flock's
  // unknowns.
  Eigen::MatrixXd Linearize();

  Workspace& work(std::size_t i) { return work_[i]; }

  template <typename Function>
  void ForEachBird(const Function& fn) {
    pool_.For(0, static_cast<std::int64_t>(work_.size()), 1,
              [&fn](std::int64_t first, std::int64_t last) {
                for (std::int64_t i = first; i < last; ++i) fn(static_cast<std::size_t>(i));
              });
  }

 private:
  void Assemble();
  void Assemble(const Bird& bird, ArrowSystem* system) const;
  // Eliminates every animal; an animal whose system is singular is damped until it is not.
  void Reduce(double damping_factor, Eigen::MatrixXd* matrix, Eigen::VectorXd* gradient);
  // One animal; false when its system is not positive definite.
  bool Reduce(double damping, Workspace* w) const;
  // The candidate that a step of the flock's unknowns, to `shared`, makes of `bird`, and its cost;
  // false when it is not finite.
  bool Step(const Eigen::VectorXd& shared_step, const Eigen::VectorXd& shared, const Bird& bird,
            Workspace* w) const;

  BatchState& state_;
  ThreadPool pool_;
  std::vector<Workspace> work_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_SOLVER_H_
