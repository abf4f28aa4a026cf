// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The batch method's problem (batch_problem.h) with forces between the animals in place of plain
// smoothness: what an acceleration has beyond the force is a Markov process,
//   e_i = z_ref (a_i - F_i) / z_i          (F: flock_forces.h; z_ref as in acceleration.h)
// which couples all animals: weak-constraint 4D-Var. Paths and the unknowns of the forces are found
// together, by Gauss-Newton with Levenberg's damping. A step is solved for by conjugate gradients
// (conjugate_gradients.h), preconditioned by every animal as if the others stood still
// (arrow_system.h): its cost is linear in the animals and in those that each one hears.
// Who hears whom is frozen between calls of Relinearize. Forces bring no scale of their own: their
// lengths are known, a little, as times of flight; and the flock's speed, with it the common scale,
// is held where it was.
// (Tremolet, "Accounting for an imperfect model in 4D-Var", 2006)

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_FLOCK_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_FLOCK_H_

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "reconstruct/cost_functions/markov.h"
#include "reconstruct/solve/arrow_system.h"
#include "reconstruct/solve/batch_problem.h"
#include "reconstruct/solve/conjugate_gradients.h"
#include "reconstruct/solve/flock_forces.h"

namespace flocklift::internal {

// When to be content.
struct Effort {
  double enough = 0.1;  // fall of the cost that counts, for each animal
  GradientStop step{.share = 1e-2, .most = 200};
  // Give up once falls as large as the last one, in every iteration that is left, could not bring
  // the cost below this.
  double hopeless = std::numeric_limits<double>::infinity();
};

class CoupledFlock {
 public:
  // A flock that grows has larger accelerations, one that is fast other usual forces: costs can be
  // compared as long as they are told at the same depth and speed.
  struct Scale {
    double log_depth = 0;  // mean of all animals' reference depths
    double log_speed = 0;  // of usual birds
  };
  // All stay the caller's; the birds, and shared, move while solving. The scale is that of the
  // birds as they come, or of another problem to compare with.
  CoupledFlock(const BatchModel& model, std::vector<Bird>* birds, Eigen::VectorXd* shared,
               const std::optional<Scale>& scale = std::nullopt);

  const Scale& scale() const { return scale_; }

  FlockForces forces;
  MarkovProcess noise{.sd = 2, .time = 0.7};  // of the acceleration beyond the forces [m/s^2, s]
  double tightness = 1;  // of what is known of the forces of usual birds, in their sds

  // Neighbours are those that are near now, accelerations count at the depths of now, and animals
  // lean into the curves of now.
  void Relinearize();

  double Cost() const;
  // The forces that explain the present paths best.
  void FitForces(int max_iterations);
  // Paths and forces. Returns whether the cost stands still.
  bool Minimize(int max_iterations, const Effort& effort = {});
  // Holds the weight of separation at that share of the usual; 1 lets it go. While it is small
  // animals can pass through each other to where all else would have them.
  void HoldSeparation(double share);

  // Vectors of all unknowns: paths and own scalars animal by animal, then the flock's, then the
  // forces'. Gradient of the cost at the present state, and after it the Gauss-Newton matrix there
  // times vectors.
  const Eigen::VectorXd& Gradient();
  template <int Count>
  void Multiply(const Columns<Count>& x, Columns<Count>* y) const;
  // After Gradient: the matrix with Levenberg's damping is factorised as far as the preconditioner
  // goes (false where that is not positive definite); then solves.
  bool Factorise(double damping);
  template <int Count>
  Columns<Count> Solve(const Columns<Count>& b, const GradientStop& stop) const;

  // The sd of the noise by MacKay's fixed point (spread_estimator.h), at the solution; none where
  // the system is singular or overflows.
  std::optional<double> EstimateNoise();
  // Posterior at the solution: sd of the log depth at every sighting, that of all depths' mean
  // taken out, and of the mean. Empty where the system is singular.
  struct DepthSds {
    std::vector<std::vector<double>> at;  // by animal
    double mean = 0;
  };
  // By so many draws of kSamples each: the root of (2 / samples) is the error of one variance.
  DepthSds Depths(int draws = 4);

 private:
  friend class OneAnimal;
  static constexpr int kSamples = 8;  // at once

  struct Knot {  // state of an animal at a knot
    Vec3d x, v, a;
    double z = 1;
  };
  struct Line {  // linearised error of one animal at one knot
    Vec3d error;
    Eigen::Matrix<double, 6, 9> state;  // of (x, v) by the three control points
    Eigen::Matrix<double, 3, 9> own;    // of the error by them
    Eigen::Vector3d by_log_speed;
    Eigen::Matrix<double, 3, kForceScalars> by_forces;
    Eigen::Matrix3d by_target;
    Eigen::Vector3d weight{1, 1, 1};  // Huber's, of the whitened row that ends here
    // What it hears ends here in edge_ and inside_: those on a rule's edge, with a derivative each
    // by their (x, v), and those well within the same rules' edges, which have one in common.
    std::size_t edge_end = 0;
    struct Inside {
      std::size_t end = 0;
      double x = 0, v = 0;  // times the unit matrix
    };
    std::array<Inside, 2> inside;
  };
  template <int Count>
  using Errors = std::vector<Eigen::Matrix<double, 3, Count>>;  // of every line

  // Lines stand in the order of time, so that who hears each other is near in memory.
  std::size_t LineOf(std::size_t bird, int knot) const {
    return line_of_[first_of_bird_[bird] + static_cast<std::size_t>(knot)];
  }
  // Calls visit(animal, its knot, line) for all.
  template <typename Visit>
  void ForEachLine(const Visit& visit) const {
    std::size_t line = 0;
    for (std::size_t g = 0; g < present_.size(); ++g) {
      for (const std::size_t i : present_[g]) {
        visit(i, static_cast<int>(g) - birds_[i].first_knot, line++);
      }
    }
  }
  std::vector<Knot> States() const;
  struct Heard {  // within reach of an animal at a knot, by increasing animal
    std::vector<Offset> offsets;
    std::vector<std::uint32_t> lines;
  };
  void Hear(std::size_t line, double reach, const std::vector<Knot>& states, Heard* heard) const;
  CameraMotion CameraAt(const Bird& bird, int knot) const;
  MarkovWhitening Whitening() const { return {noise, model_.knot_interval}; }
  double ForcePriors(Eigen::MatrixXd* matrix, Eigen::VectorXd* gradient) const;
  void Move(const Eigen::VectorXd& step);
  int border() const { return model_.shared() + forces.size(); }

  // coupled_rows.cc
  void Linearize();
  // What there is room for while lines are visited.
  struct Scratch {
    PairForce pairs;
    Heard heard;
    std::vector<ByOffset> by;
    std::vector<std::size_t> zones;  // of line.inside
  };
  // How an animal's state at a knot, and its acceleration times z_ref / z, follow from its path.
  void LinearizeState(std::size_t bird, int knot, Line* line) const;
  // After it, with the force there and the derivatives of it: the error, by its own unknowns.
  void LinearizeError(std::size_t bird, const Knot& state, const Vec3d& force,
                      std::span<const ByOffset> by, const SelfDerivatives& self, Line* line) const;
  void LinearizeLine(std::size_t bird, int knot, const std::vector<Knot>& states, double reach,
                     Scratch* scratch);
  ArrowSystem::Rows RowsOf(std::size_t bird, int knot, const MarkovWhitening& whitening) const;

  // coupled_system.cc: how the errors change with the unknowns, by the animal's own (border
  // included) and by those of its neighbours; whitened, weighted and whitened back; and the way
  // back from errors to unknowns.
  template <int Count>
  void ChangesOf(const Columns<Count>& x, Errors<Count>* own, Errors<Count>* heard) const;
  template <int Count>
  void Weigh(Errors<Count>* errors) const;
  template <int Count>
  void PullOwn(const Errors<Count>& errors, Columns<Count>* y) const;
  template <int Count>
  void PullHeard(const Errors<Count>& errors, Columns<Count>* y) const;

  // coupled_posterior.cc: draws from the posterior, side by side.
  Columns<kSamples> Draw(std::uint64_t seed, const GradientStop& stop) const;

  const BatchModel& model_;
  std::vector<Bird>& birds_;
  Eigen::VectorXd& shared_;
  std::vector<std::size_t> first_of_bird_, line_of_;  // place in the latter; animal by animal
  std::vector<Eigen::Index> place_;  // of every animal's first unknown, then of the border
  std::vector<std::vector<std::size_t>> present_;     // animals at every knot of the sequence
  std::vector<std::vector<std::uint32_t>> may_hear_;  // lines, of every line
  Scale scale_;
  Eigen::VectorXd usual_;  // unknowns of the forces of usual birds
  double separation_ = 1;  // of theirs, below 1 held
  std::vector<Line> lines_;
  std::vector<std::uint32_t> edge_, inside_;  // lines that every line hears
  std::vector<ByOffset> by_edge_;             // of its error, by (x, v) of each on an edge
  std::vector<ArrowSystem> animals_;          // each as if the others stood still
  Eigen::MatrixXd priors_;                    // of the border
  Eigen::VectorXd gradient_, diagonal_;
  double damping_ = 0;
  Eigen::LLT<Eigen::MatrixXd> border_factor_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_COUPLED_FLOCK_H_
