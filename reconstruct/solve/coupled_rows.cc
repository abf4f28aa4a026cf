// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Linearisation of the flock with forces: what every whitened error says of the animal itself, of
// its neighbours and of the forces.

#include <ceres/jet.h>

#include <algorithm>
#include <array>

#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/coupled_point.h"
#include "simulate/core/check.h"

namespace flocklift::internal {
namespace {

using Jet9 = ceres::Jet<double, 9>;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

Eigen::Vector3d AsEigen(const Vec3d& v) { return {v.x, v.y, v.z}; }

}  // namespace

void CoupledFlock::LinearizeState(std::size_t bird, int knot, Line* line) const {
  const Bird& b = birds_[bird];
  std::array<Jet9, 9> path;
  for (int a = 0; a < 9; ++a) path[Index(a)] = Jet9(b.path[Index(3 * knot + a)], a);
  const PathPoint<Jet9> p = PointOf(path.data(), 1 / model_.knot_interval, CameraAt(b, knot));
  const std::array<const Jet9*, 6> parts = {&p.x.x, &p.x.y, &p.x.z, &p.v.x, &p.v.y, &p.v.z};
  for (int a = 0; a < 6; ++a) line->state.row(a) = parts[Index(a)]->v;
  const std::array<const Jet9*, 3> a_over_z = {&p.a_over_z.x, &p.a_over_z.y, &p.a_over_z.z};
  for (int axis = 0; axis < 3; ++axis) {
    line->own.row(axis) = b.reference_depth * a_over_z[Index(axis)]->v;
  }
}

void CoupledFlock::LinearizeError(std::size_t bird, const Knot& state, const Vec3d& force,
                                  std::span<const ByOffset> by, const SelfDerivatives& self,
                                  Line* line) const {
  const double factor = birds_[bird].reference_depth / state.z;
  line->error = factor * (state.a - force);
  Matrix36 by_own = self.by_state;
  for (const ByOffset& b : by) {
    by_own.leftCols<3>().diagonal().array() -= b.x;
    if (b.on_edge()) by_own.leftCols<3>().noalias() -= b.across * b.along.transpose();
    by_own.rightCols<3>().diagonal().array() -= b.v;
  }
  line->own.noalias() -= factor * by_own * line->state;
  // 1 / z falls as log z, (1, 4, 1) / 6 of three control points, rises.
  for (int axis = 0; axis < 3; ++axis) {
    for (int c = 0; c < 3; ++c) {
      line->own(axis, 3 * c + 2) += factor * Component(force, axis) * (c == 1 ? 4.0 : 1.0) / 6;
    }
  }
  line->by_log_speed = -factor * self.by_log_speed;
}

void CoupledFlock::LinearizeLine(std::size_t bird, int knot, const std::vector<Knot>& states,
                                 double reach, Scratch* scratch) {
  const double time = (birds_[bird].first_knot + knot) * model_.knot_interval;
  const std::size_t at = LineOf(bird, knot);
  Line& line = lines_[at];
  auto& [pairs, heard, by, zones] = *scratch;
  LinearizeState(bird, knot, &line);
  Hear(at, reach, states, &heard);
  by.resize(heard.lines.size());
  PairUnknownsMatrix by_pair;
  SelfDerivatives self;
  const Knot& s = states[at];
  const Vec3d force = pairs(heard.offsets, by.data(), &by_pair) +
                      SelfForce(forces, birds_[bird].own[kOwnLogSpeed], time, s.x, s.v, &self);
  LinearizeError(bird, s, force, by, self, &line);
  const double factor = birds_[bird].reference_depth / s.z;
  // Those who are too near to it are in one zone, the others in another.
  constexpr std::size_t kZones = std::tuple_size_v<decltype(line.inside)>;
  line.inside = {};
  std::size_t known = 0;
  zones.clear();
  for (ByOffset& b : by) {
    b = {-factor * b.x, -factor * b.v, -factor * b.across, b.along};
    std::size_t zone = b.on_edge() ? kZones : 0;
    while (zone < known && (line.inside[zone].x != b.x || line.inside[zone].v != b.v)) ++zone;
    if (zone == known && known < kZones) line.inside[known++] = {.x = b.x, .v = b.v};
    zones.push_back(zone);
  }
  for (std::size_t zone = 0; zone < kZones; ++zone) {
    for (std::size_t n = 0; n < by.size(); ++n) {
      if (zones[n] == zone) inside_.push_back(heard.lines[n]);
    }
    line.inside[zone].end = inside_.size();
  }
  for (std::size_t n = 0; n < by.size(); ++n) {
    if (zones[n] < kZones) continue;
    edge_.push_back(heard.lines[n]);
    by_edge_.push_back(by[n]);
  }
  line.edge_end = edge_.size();
  line.by_forces << -factor * by_pair, -factor * self.by_unknowns;
  line.by_target = -factor * self.by_target;
}

ArrowSystem::Rows CoupledFlock::RowsOf(std::size_t bird, int knot,
                                       const MarkovWhitening& whitening) const {
  const bool first = knot == 0;
  ArrowSystem::Rows rows;
  rows.first = first ? 0 : 3 * (knot - 1);
  rows.residual.setZero();
  rows.path.setZero();
  rows.own = kOwnLogSpeed;
  rows.by_own.setZero();
  auto& [scalars, targets] = rows.by_shared;
  static_assert(kForceScalars <= ArrowSystem::Rows::Run::kMost);
  scalars = {model_.shared(), Eigen::Matrix<double, 3, kForceScalars>::Zero()};
  const auto target_at = [&](int back) {
    return forces.ShareAt((birds_[bird].first_knot + knot - back) * model_.knot_interval);
  };
  const int first_target = target_at(first ? 0 : 1).knot, last_target = target_at(0).knot;
  targets.first = model_.shared() + kForceScalars + 3 * first_target;
  const int width = 3 * (last_target + 2 - first_target);
  FLOCKLIFT_DCHECK(width <= ArrowSystem::Rows::Run::kMost);
  targets.by.setZero(3, width);
  for (int l = 0; l < (first ? 1 : 2); ++l) {
    const double share = (l == 0 ? 1 : -whitening.rho) * whitening.At(knot);
    const Line& line = lines_[LineOf(bird, knot - l)];
    rows.residual += share * AsEigen(line.error);
    rows.path.middleCols<9>(first || l == 1 ? 0 : 3) += share * line.own;
    rows.by_own += share * line.by_log_speed;
    scalars.by += share * line.by_forces;
    const FlockForces::Share target = target_at(l);
    const int at = 3 * (target.knot - first_target);
    targets.by.middleCols<3>(at) += share * (1 - target.next) * line.by_target;
    targets.by.middleCols<3>(at + 3) += share * target.next * line.by_target;
  }
  return rows;
}

void CoupledFlock::Linearize() {
  const std::vector<Knot> states = States();
  const double reach = forces.Reach();
  inside_.clear();
  edge_.clear();
  by_edge_.clear();
  Scratch scratch{.pairs = PairForce(forces), .heard = {}, .by = {}, .zones = {}};
  ForEachLine(
      [&](std::size_t i, int k, std::size_t) { LinearizeLine(i, k, states, reach, &scratch); });
  priors_.setZero(border(), border());
  Eigen::VectorXd of_priors = Eigen::VectorXd::Zero(border());
  const int n = model_.shared();
  Eigen::MatrixXd shared_priors = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd of_shared = Eigen::VectorXd::Zero(n);
  SharedPriors(model_, shared_, &shared_priors, &of_shared);
  priors_.topLeftCorner(n, n) = shared_priors;
  of_priors.head(n) = of_shared;
  ForcePriors(&priors_, &of_priors);

  gradient_.setZero(place_.back() + border());
  diagonal_.setZero(gradient_.size());
  gradient_.tail(border()) = of_priors;
  diagonal_.tail(border()) = priors_.diagonal();
  Errors<1> pulls(lines_.size());
  const MarkovWhitening whitening = Whitening();
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Bird& bird = birds_[i];
    ArrowSystem& animal = animals_[i];
    animal.SetZero();
    const auto add = [&animal](Term term, const ResidualRow& row) {
      animal.Add(row, RobustWeight(term, row.residual));
    };
    ForEachRow(model_, bird, shared_, true, add, RowKind::kNoAccelerations);
    for (int k = 0; k < bird.knots; ++k) {
      const ArrowSystem::Rows rows = RowsOf(i, k, whitening);
      Line& line = lines_[LineOf(i, k)];
      for (int axis = 0; axis < 3; ++axis) {
        line.weight[axis] = RobustWeight(Term::kAcceleration, rows.residual[axis]);
      }
      animal.Add(rows, line.weight);
      pulls[LineOf(i, k)] = AsEigen(line.error);
    }
    animal.GatherBorder();
    const int unknowns = bird.unknowns() + kOwnUnknowns;
    gradient_.segment(place_[i], unknowns) += animal.gradient().head(unknowns);
    gradient_.tail(border()) += animal.gradient().tail(border());
    for (int a = 0; a < bird.unknowns(); ++a) {
      diagonal_[place_[i] + a] = a % 3 == 2 ? ArrowSystem::kDepthMetric : animal.Diagonal(a);
    }
    const auto corner = animal.corner().diagonal();
    diagonal_.segment<kOwnUnknowns>(place_[i] + bird.unknowns()) = corner.head<kOwnUnknowns>();
    diagonal_.tail(border()) += corner.tail(border());
  }
  Weigh<1>(&pulls);
  PullHeard<1>(pulls, &gradient_);
}

}  // namespace flocklift::internal
