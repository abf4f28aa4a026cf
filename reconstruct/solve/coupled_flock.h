// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The batch method's problem (batch_problem.h) with forces between the animals in place of plain
// smoothness: what an acceleration has beyond the force is a Markov process,
//   e_i = z_ref (a_i - F_i) / z_i          (F: flock_forces.h; z_ref as in acceleration.h)
// which couples all animals: weak-constraint 4D-Var. Paths and the unknowns of the forces are found
// together, by Gauss-Newton with Levenberg's damping on one system banded in time (time_system.h).
// Who hears whom is frozen between calls of Relinearize. Forces bring no scale of their own: their
// lengths are known, a little, as times of flight.
// (Tremolet, "Accounting for an imperfect model in 4D-Var", 2006)

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_FLOCK_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_FLOCK_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "reconstruct/cost_functions/markov.h"
#include "reconstruct/solve/batch_problem.h"
#include "reconstruct/solve/flock_forces.h"
#include "reconstruct/solve/time_system.h"

namespace flocklift::internal {

class CoupledFlock {
 public:
  // All stay the caller's; the birds in `moving`, and shared, move while solving. The others are
  // heard as they are.
  CoupledFlock(const BatchModel& model, std::vector<int> moving, std::vector<Bird>* birds,
               Eigen::VectorXd* shared);

  FlockForces forces;
  MarkovProcess noise{.sd = 2, .time = 0.7};  // of the acceleration beyond the forces [m/s^2, s]
  double tightness = 1;       // of what is known of the forces of usual birds, in their sds
  bool flock_is_free = true;  // do the flock's unknowns and those of the forces move?

  // Neighbours are those that are near now, and accelerations count at the depths of now.
  void Relinearize();

  double Cost() const;
  // The forces that explain the present paths best.
  void FitForces(int max_iterations);
  // Paths and forces. Returns whether the cost stands still.
  bool Minimize(int max_iterations);

  // Gradient of the cost at the present state: paths and own scalars animal by animal, then the
  // flock's, then the forces'.
  Eigen::VectorXd Gradient();

  // The sd of the noise by MacKay's fixed point (spread_estimator.h), at the solution.
  double EstimateNoise();
  // Posterior at the solution: sd of the log depth at every sighting of the moving animals, and of
  // their mean. Empty where the system is singular.
  struct DepthSds {
    std::vector<std::vector<double>> at;  // by animal
    double mean = 0;
  };
  DepthSds Depths();

 private:
  struct Knot {  // state of an animal at a knot
    Vec3d x, v, a;
    double z = 1;
  };
  struct Line {  // linearised error of one animal at one knot
    Vec3d error;
    Eigen::Matrix<double, 6, 9> state;            // of (x, v) by the three control points
    Eigen::Matrix<double, 3, 9> own;              // of the error by them
    std::vector<Eigen::Matrix<double, 3, 9>> by;  // of the error by the neighbours' control points
    Eigen::Vector3d by_log_speed;
    Eigen::Matrix<double, 3, kForceScalars> by_forces;
    Eigen::Matrix3d by_target;
    Vec3d weight{1, 1, 1};  // Huber's
  };
  // Derivatives of three errors: by animals' unknowns at four times on end, and by the border.
  struct Rows {
    int first_time = 0;
    std::array<std::vector<int>, TimeSystem::kSpan> columns;  // of each animal's three unknowns
    std::array<Eigen::Matrix<double, 3, Eigen::Dynamic>, TimeSystem::kSpan> by;
    std::vector<int> border;
    Eigen::Matrix<double, 3, Eigen::Dynamic> by_border;
  };

  std::vector<Knot> States() const;
  std::vector<Offset> OffsetsOf(std::size_t bird, int knot, const std::vector<Knot>& states) const;
  Vec3d ErrorOf(std::size_t bird, int knot, const std::vector<Knot>& states) const;
  CameraMotion CameraAt(const Bird& bird, int knot) const;
  double Whitening(int knot) const;  // of the row that ends at this knot of its animal
  std::size_t LineOf(int bird, int time) const;
  bool Moves(int bird) const { return !column_[static_cast<std::size_t>(bird)].empty(); }
  double ForcePriors(Eigen::MatrixXd* matrix, Eigen::VectorXd* gradient) const;
  void Move(const TimeSystem::Step& step);

  // coupled_rows.cc
  void Linearize();
  void LinearizeLine(std::size_t bird, int knot, const std::vector<Knot>& states);
  // factor times the error at the knot, minus as much of rho times that at the knot before.
  Rows RowsOf(std::size_t bird, int knot, double factor, double rho) const;
  void AddRows(const Rows& rows, const Vec3d& residual, const Vec3d& weight);
  void AddBatchRow(std::size_t bird, const ResidualRow& row, double weight);
  int BorderOf(std::size_t bird, int index) const;  // of ResidualRow's border
  int FlockBorder() const { return kOwnUnknowns * static_cast<int>(moving_.size()); }
  int ForceBorder() const { return FlockBorder() + model_.shared(); }

  // coupled_posterior.cc
  Vec3d VarianceOf(const Rows& rows, const TimeSystem::Posterior& posterior) const;

  const BatchModel& model_;
  std::vector<int> moving_;  // by increasing animal
  std::vector<Bird>& birds_;
  Eigen::VectorXd& shared_;
  std::vector<std::size_t> first_line_;       // of every animal
  std::vector<int> place_;                    // of every animal that moves, among those
  std::vector<std::vector<int>> column_;      // of every control point that moves, in its block
  std::vector<std::vector<int>> present_;     // animals at every knot of the sequence
  std::vector<std::vector<int>> neighbours_;  // of every line, by increasing animal
  Eigen::VectorXd usual_;                     // unknowns of the forces of usual birds,
  double usual_log_speed_ = 0;                // which fly that fast
  std::vector<Line> lines_;
  TimeSystem system_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_FLOCK_H_
