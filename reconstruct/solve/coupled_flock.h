// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The batch method's problem (batch_problem.h) with forces between the animals in place of plain
// smoothness: what an acceleration has beyond the force is a Markov process,
//   e_i = z_ref (a_i - F_i) / z_i          (F: flock_forces.h; z_ref as in acceleration.h)
// which couples all animals: weak-constraint 4D-Var. Gauss-Newton with Levenberg's damping; the
// step by conjugate gradients, preconditioned by every animal's own arrow (arrow_system.h), in
// which the others stand still. Who hears whom is frozen between calls of FreezeNeighbours.
// (Tremolet, "Accounting for an imperfect model in 4D-Var", 2006)

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_FLOCK_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_FLOCK_H_

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "reconstruct/cost_functions/markov.h"
#include "reconstruct/solve/arrow_system.h"
#include "reconstruct/solve/batch_problem.h"
#include "reconstruct/solve/flock_forces.h"

namespace flocklift::internal {

class CoupledFlock {
 public:
  // All three stay the caller's; birds and shared move while solving.
  CoupledFlock(const BatchModel& model, std::vector<Bird>* birds, Eigen::VectorXd* shared);

  FlockForces forces;
  MarkovProcess noise{.sd = 2, .time = 0.7};  // of the acceleration beyond the forces [m/s^2, s]

  // Those that are near at the present positions; takes the animals' own speeds as they are, too.
  void FreezeNeighbours();

  // The gains (none below 0) and the pull that explain the present accelerations best, given the
  // radii; the sum of the squared whitened residuals, priors included.
  double FitGains();
  // Looks for better radii one after the other, with the best gains for each.
  void FitRadii();
  // The root mean square of what the forces leave unexplained [m/s^2].
  double UnexplainedSd() const;

  double Cost() const;
  // Returns whether the cost stands still.
  bool Minimize(int max_iterations, const std::function<void()>& on_iteration);

  // Gradient of the cost at the present state: paths and own scalars animal by animal, then the
  // flock's.
  Eigen::VectorXd Gradient();

 private:
  struct Knot {  // state of an animal at a knot
    Vec3d x, v, a;
    double z = 1;
  };
  struct Line {  // linearised error of one animal at one knot
    Vec3d error;
    Eigen::Matrix<double, 6, 9> state;  // of (x, v) by the three control points
    Eigen::Matrix<double, 3, 9> own;    // of the error by them
    std::vector<Matrix36> by;           // of the error by the neighbours' (x, v)
    Vec3d weight{1, 1, 1};              // Huber's
  };

  std::vector<Knot> States() const;
  std::vector<Offset> OffsetsOf(std::size_t bird, int knot, const std::vector<Knot>& states) const;
  Vec3d ErrorOf(std::size_t bird, int knot, const std::vector<Knot>& states) const;
  CameraMotion CameraAt(const Bird& bird, int knot) const;
  double Whitening(int knot) const;  // of the row that ends at this knot of its animal
  void Linearize();
  void AddOwnRows(std::size_t bird);
  void AddNeighbourRows(std::size_t bird, int knot);
  Eigen::VectorXd Apply(const Eigen::VectorXd& x, double damping) const;
  // Adds J^T W (J x - or the residuals where x is null).
  void AddDynamics(const Eigen::VectorXd* x, Eigen::VectorXd* y) const;
  Eigen::VectorXd Precondition(const Eigen::MatrixXd& shared_matrix, const Eigen::VectorXd& x);
  bool Step(double damping, Eigen::VectorXd* step);

  const BatchModel& model_;
  std::vector<Bird>& birds_;
  Eigen::VectorXd& shared_;
  std::vector<std::size_t> first_line_;            // of every animal
  std::vector<Eigen::Index> offset_;               // of every animal's unknowns; last: the flock's
  std::vector<std::vector<int>> neighbours_;       // of every line, by increasing animal
  std::vector<std::vector<std::size_t>> present_;  // animals at every knot of the sequence
  std::vector<double> cruising_speed_;             // of every animal [m/s]
  std::vector<Line> lines_;
  std::vector<ArrowSystem> batch_, blocks_;  // without the forces, and with their diagonal blocks
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_FLOCK_H_
