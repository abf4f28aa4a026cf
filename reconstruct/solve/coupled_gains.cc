// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The forces that explain the present paths best: gains by linear least squares, radii by a search.

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/coupled_point.h"

namespace flocklift::internal {

double CoupledFlock::FitGains() {
  // What birds are like (simulate/flock/boids.h), and how sure that is. Strong: errors of position
  // make all of a neighbour's influence look weaker than it is (regression dilution), and left to
  // themselves the gains fade away. Then the sds of a pull and of its steps.
  constexpr std::array<double, kForceGains> kMean = {1, 0.05, 0.5, 0.5, 0, 0};
  constexpr std::array<double, kForceGains> kSd = {0.05, 0.005, 0.02, 0.03, 0.05, 0.1};
  constexpr double kPullSd = 5, kPullStepSd = 0.3;
  const std::size_t knots = forces.pull.size();
  const Eigen::Index size = kForceGains + 3 * static_cast<Eigen::Index>(knots);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  double squares = 0;
  const auto add = [&](const Eigen::VectorXd& row, double value) {
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(row);
    right += value * row;
    squares += value * value;
  };
  for (Eigen::Index p = 0; p < kForceGains; ++p) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
    row[p] = 1 / kSd[static_cast<std::size_t>(p)];
    add(row, kMean[static_cast<std::size_t>(p)] / kSd[static_cast<std::size_t>(p)]);
  }
  for (Eigen::Index p = 0; p < size - kForceGains; ++p) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
    row[kForceGains + p] = p < 3 ? 1 / kPullSd : 1 / kPullStepSd;
    if (p >= 3) row[kForceGains + p - 3] = -1 / kPullStepSd;
    add(row, 0);
  }
  const std::vector<Knot> states = States();
  const double rho = noise.Correlation(model_.knot_interval);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const double cruising = cruising_speed_[i];
    std::array<Eigen::VectorXd, 3> rows, before;
    std::array<double, 3> values{}, values_before{};
    for (int k = 0; k < birds_[i].knots; ++k) {
      const Knot& s = states[first_line_[i] + static_cast<std::size_t>(k)];
      const auto unit = UnitForces(forces, cruising, OffsetsOf(i, k, states), s.x, s.v);
      const double factor = birds_[i].reference_depth / s.z;
      const double place =
          std::clamp((birds_[i].first_knot + k) * model_.knot_interval / kPullKnotTime, 0.0,
                     static_cast<double>(knots) - 1);
      const Eigen::Index left =
          std::min(static_cast<Eigen::Index>(place), static_cast<Eigen::Index>(knots) - 2);
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        rows[a] = Eigen::VectorXd::Zero(size);
        for (int p = 0; p < kForceGains; ++p) {
          rows[a][p] = factor * Component(unit[static_cast<std::size_t>(p)], axis);
        }
        rows[a][kForceGains + 3 * left + axis] = factor * (1 - (place - static_cast<double>(left)));
        rows[a][kForceGains + 3 * (left + 1) + axis] = factor * (place - static_cast<double>(left));
        values[a] = factor * Component(s.a, axis);
        if (k == 0) {
          add(Whitening(k) * rows[a], Whitening(k) * values[a]);
        } else {
          add(Whitening(k) * (rows[a] - rho * before[a]),
              Whitening(k) * (values[a] - rho * values_before[a]));
        }
      }
      before = rows;
      values_before = values;
    }
  }
  matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose();
  // The most negative gain is held at 0 until none is left.
  Eigen::VectorXd solution;
  for (;;) {
    solution = matrix.llt().solve(right);
    Eigen::Index worst = 0;
    const double least = solution.head(kForceGains).minCoeff(&worst);
    if (least >= 0) break;
    matrix.row(worst).setZero();
    matrix.col(worst).setZero();
    matrix(worst, worst) = 1;
    right[worst] = 0;
  }
  forces.alpha_s = solution[0];
  forces.alpha_c = solution[1];
  forces.alpha_a = solution[2];
  forces.cruise = solution[3];
  forces.level = solution[4];
  forces.spring = solution[5];
  for (std::size_t p = 0; p < knots; ++p) {
    const Eigen::Index at = kForceGains + 3 * static_cast<Eigen::Index>(p);
    forces.pull[p] = {solution[at], solution[at + 1], solution[at + 2]};
  }
  return squares - solution.dot(right);
}

void CoupledFlock::FitRadii() {
  FreezeNeighbours();
  double best = FitGains();
  for (double FlockForces::*radius : {&FlockForces::d_v, &FlockForces::d_s}) {
    const double from = forces.*radius;
    double chosen = from;
    for (const double factor : {0.6, 0.8, 1.25, 1.6}) {
      forces.*radius = factor * from;
      if (forces.d_s > forces.d_v) continue;
      FreezeNeighbours();
      const double squares = FitGains();
      if (squares >= best) continue;
      best = squares;
      chosen = forces.*radius;
    }
    forces.*radius = chosen;
  }
  FreezeNeighbours();
  FitGains();
}

}  // namespace flocklift::internal
