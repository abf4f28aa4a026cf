// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the flock does to one of its animals, by the terms of boids that the simulator runs
// (simulate/flock/boids.h), with smooth edges and derivatives. In the axes of the camera:
//   F_i = separation + cohesion + alignment                      (of its neighbours)
//       + cruise (d m_i - |v|) v/|v| - level (v . up) up + goal g / sqrt(1 + |g|^2 / range^2)
// m_i is the animal's mean speed: what it would fly alone is that times d, `drive`. g = target(t) -
// x leads to a goal that nobody has told, linear between knots of time.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_FLOCK_FORCES_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_FLOCK_FORCES_H_

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "simulate/core/vec3.h"
#include "simulate/flock/boids.h"

namespace flocklift::internal {

// Places among the unknowns of the forces: logarithms of all that is positive, those of the
// neighbours' forces first; then the target's knots, three values each [m].
enum ForceUnknown {
  kLogDs,
  kLogDv,
  kLogTaper,
  kLogAlphaS,
  kLogAlphaC,
  kLogAlphaA,
  kLogCruise,
  kLogDrive,
  kLogLevel,
  kLogGoal,
  kLogRange,
  kForceScalars,
};
inline constexpr int kPairUnknowns = kLogCruise, kSelfUnknowns = kForceScalars - kPairUnknowns;
inline constexpr double kTargetKnotTime = 4;  // [s]
// Lengths grow with the scale of the scene.
constexpr bool IsLength(int unknown) { return unknown <= kLogTaper || unknown == kLogRange; }

struct FlockForces {
  Eigen::VectorXd unknowns;
  std::optional<Vec3d> up_in_cam;

  // Of usual birds of that speed [m/s], with the target at `center`, for so many seconds.
  static FlockForces Usual(const Vec3d& center, double speed, double duration);

  int size() const { return static_cast<int>(unknowns.size()); }
  int target_knots() const { return (size() - kForceScalars) / 3; }
  double operator[](ForceUnknown k) const;  // as it is, not its logarithm
  double Reach() const { return (*this)[kLogDv] + 0.5 * (*this)[kLogTaper]; }
  struct Share {  // of the target at one time
    int knot;     // and the next
    double next;  // weight of the next
  };
  Share ShareAt(double time) const;
  Vec3d TargetAt(double time) const;
};

// x_j - x_i and v_j - v_i.
struct Offset {
  Vec3d dx, dv;
};

using Matrix36 = Eigen::Matrix<double, 3, 6>;

// Derivatives of a force by a neighbour's (dx, dv): [x I + across along^T, v I], for offsets and
// velocities are averaged, with weights that change with distance on the rules' edges alone.
struct ByOffset {
  double x = 0, v = 0;
  Eigen::Vector3d across = Eigen::Vector3d::Zero(), along = Eigen::Vector3d::Zero();

  bool on_edge() const { return across != Eigen::Vector3d::Zero(); }
  Eigen::Matrix3d ByPosition() const {
    return x * Eigen::Matrix3d::Identity() + across * along.transpose();
  }
};

// How much a neighbour counts by its distance: TaperWindow of its square, with derivatives.
struct Weight {
  double value = 0, by_square = 0, by_radius = 0, by_taper = 0;
};
class WeightWindow {
 public:
  WeightWindow(double radius, double taper);
  double ValueAt(double square) const;
  Weight At(double square) const;

 private:
  double radius_, taper_;
  double inner_, outer_;  // squared distances up to which it is 1, from which on 0
};

// The force of neighbours; where `by_unknowns` is there, its derivatives too: by the first
// kPairUnknowns unknowns, and by each one's (dx, dv) at `by_offsets` (may be null without any).
using PairUnknownsMatrix = Eigen::Matrix<double, 3, kPairUnknowns>;
class PairForce {
 public:
  explicit PairForce(const FlockForces& forces);
  Vec3d operator()(std::span<const Offset> offsets, ByOffset* by_offsets,
                   PairUnknownsMatrix* by_unknowns);

  // The same in parts: what one neighbour adds, the force of a sum, and its derivatives by one that
  // is in the sum.
  using Sums = BoidsPairs<double>::Sums;
  BoidsPairs<double>::Shares SharesOf(const Offset& offset) const;
  Vec3d ForceOf(const Sums& sums) const { return rules_.Finish(sums); }
  ByOffset ByOne(const Sums& sums, const Offset& offset) const;

 private:
  BoidsPairs<double> rules_;
  WeightWindow near_, seen_;
  std::vector<std::array<Weight, 2>> weights_;  // of every neighbour, by both windows
};

// The rest, and its derivatives where they are wanted.
struct SelfDerivatives {
  Matrix36 by_state;                                    // (x, v)
  Eigen::Vector3d by_log_speed;                         // log m_i
  Eigen::Matrix<double, 3, kSelfUnknowns> by_unknowns;  // from kLogCruise on
  Eigen::Matrix3d by_target;
};
Vec3d SelfForce(const FlockForces& forces, double log_speed, double time, const Vec3d& x,
                const Vec3d& v, SelfDerivatives* derivatives);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_FLOCK_FORCES_H_
