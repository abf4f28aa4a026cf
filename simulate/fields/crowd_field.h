// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Continuum crowds, the field that the swarm models are compared with: everybody follows a
// potential that is recomputed from where all the others are and go. A. Treuille, S. Cooper,
// Z. Popovic, "Continuum crowds", ACM Trans. Graph. 25 (2006) 1160-1168; there on the ground, here
// in space as well (a grid with one node along z is the ground). On the nodes of a grid, in this
// order, n the unit vector from a node to its neighbour k:
//   density    rho = sum over animals of (min over axes of the trilinear factor)^lambda
//   flow       v = sum of that weight times the animal's velocity / rho
//   speed      f_k = f_max                                       rho_k <= rho_low
//                  = v_k . n, at least f_min                     rho_k >= rho_high
//              and linear in rho_k between the two
//   unit cost  c_k = (alpha f_k + beta + gamma g_k) / f_k,  g the repulsion of obstacles (bell.h)
//   potential  sum over axes of ((phi - phi_k) / (c_k l))^2 = 1, phi = 0 in the group's goals
//   velocity   -f_k (grad phi)_k / |grad phi| along each axis
// k runs over the cheaper of the two neighbours along each axis. So who walks with the flow is not
// slowed, and who walks against it pays, goes round, or falls in behind others: lanes.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_CROWD_FIELD_H_
#define FLOCKLIFT_SIMULATE_FIELDS_CROWD_FIELD_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simulate/fields/bell.h"
#include "simulate/fields/cost_heap.h"
#include "simulate/fields/grid_field.h"
#include "simulate/fields/solids.h"

namespace flocklift {

struct CrowdOptions {
  double length_weight = 0.8;       // alpha, cost of a metre, >= 0
  double time_weight = 0.8;         // beta, cost of a second, > 0
  double discomfort_weight = 0.4;   // gamma, cost of a second along a surface, >= 0
  double max_speed = 1;             // f_max [m/s]
  double min_speed = 0.05;          // f_min, against the flow of a dense crowd [m/s], > 0
  double density_low = 0.5;         // rho_low [animals per node], >= 2^-lambda: one is no crowd
  double density_high = 1.5;        // rho_high [animals per node], > rho_low
  double density_exponent = 1;      // lambda, > 0
  double diagonal = kCellDiagonal;  // of the repulsion [spacings], as in cost_field.h
};

class CrowdField {
 public:
  // `distance` to the obstacles [m]; its grid is the field's. A group per element of `goals`, with
  // at least one goal each. Starts empty. Throws std::invalid_argument for options out of range.
  CrowdField(const ScalarField& distance, const CrowdOptions& options,
             std::span<const std::vector<Solid>> goals, int threads = 1);

  // Goals that have moved, of as many groups as before; followed from the next Update on.
  void SetGoals(std::span<const std::vector<Solid>> goals);

  // Takes in where all animals of all groups are and go [m, m/s]: density, flow, and every group's
  // potential. Groups are solved on several threads, with the same bytes as on one.
  void Update(std::span<const Vec3d> positions, std::span<const Vec3d> velocities);

  const Grid& grid() const { return distance_.grid; }
  const ScalarField& distance() const { return distance_; }
  double Density(std::size_t node) const { return density_[node]; }  // rho [animals per node]
  const Vec3d& Flow(std::size_t node) const { return flow_[node]; }  // v [m/s]
  // f of arriving at `node` along the unit vector `direction` [m/s].
  double Speed(std::size_t node, const Vec3d& direction) const;
  // phi of a group; infinite in walls and where its goals cannot be reached.
  float Potential(std::size_t group, std::size_t node) const {
    return groups_[group].potential[node];
  }

  // What an animal of a group should do [m/s]: the nodes' velocities, interpolated; 0 in a goal.
  Vec3d Velocity(std::size_t group, const Vec3d& point) const;

 private:
  struct Group {
    std::vector<Solid> goals;
    std::vector<std::size_t> seeds;  // nodes in the goals
    std::vector<float> potential;
    std::vector<Vec3d> velocity;
    internal::CostHeap heap;
  };
  bool IsWall(std::size_t node) const { return distance_.values[node] < 0; }
  void Solve(Group* group) const;
  Vec3d VelocityAt(const Group& group, std::size_t node) const;

  ScalarField distance_;
  CrowdOptions options_;
  int threads_;
  std::vector<double> density_;
  std::vector<Vec3d> flow_;
  std::vector<double> discomfort_;          // g
  std::vector<std::array<float, 6>> step_;  // c_k l by side; infinite: a wall or beyond the grid
  std::vector<Group> groups_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_CROWD_FIELD_H_
