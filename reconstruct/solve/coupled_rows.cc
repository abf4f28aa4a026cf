// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Linearisation of the flock with forces: what every whitened error says of the animal itself and
// of its neighbours.

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <limits>

#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/coupled_point.h"

namespace flocklift::internal {
namespace {

using Jet9 = ceres::Jet<double, 9>;
using Vector3 = Eigen::Vector3d;

Vector3 AsEigen(const Vec3d& v) { return {v.x, v.y, v.z}; }

}  // namespace

void CoupledFlock::Linearize() {
  const std::vector<Knot> states = States();
  const double rate = 1 / model_.knot_interval;
  const double rho = noise.Correlation(model_.knot_interval);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Bird& bird = birds_[i];
    for (int k = 0; k < bird.knots; ++k) {
      Line& line = lines_[first_line_[i] + static_cast<std::size_t>(k)];
      std::array<Jet9, 9> path;
      for (int a = 0; a < 9; ++a) {
        path[static_cast<std::size_t>(a)] = Jet9(bird.path[static_cast<std::size_t>(3 * k + a)], a);
      }
      const PathPoint<Jet9> p = PointOf(path.data(), rate, CameraAt(bird, k));
      const std::array<const Jet9*, 6> parts = {&p.x.x, &p.x.y, &p.x.z, &p.v.x, &p.v.y, &p.v.z};
      for (int a = 0; a < 6; ++a) line.state.row(a) = parts[static_cast<std::size_t>(a)]->v;
      const std::vector<Offset> offsets = OffsetsOf(i, k, states);
      line.by.resize(offsets.size());
      Matrix36 of_self;
      const Knot& s = states[first_line_[i] + static_cast<std::size_t>(k)];
      const Vec3d force =
          PairForce(forces, offsets, line.by.data()) +
          SelfForce(forces, cruising_speed_[i], (bird.first_knot + k) * model_.knot_interval, s.x,
                    s.v, &of_self);
      const double factor = bird.reference_depth / s.z;
      line.error = factor * (s.a - force);
      Matrix36 by_own = of_self;
      for (Matrix36& by : line.by) {
        by_own -= by;
        by *= -factor;
      }
      line.own = -factor * by_own * line.state;
      const std::array<const Jet9*, 3> a_over_z = {&p.a_over_z.x, &p.a_over_z.y, &p.a_over_z.z};
      for (int axis = 0; axis < 3; ++axis) {
        line.own.row(axis) += bird.reference_depth * a_over_z[static_cast<std::size_t>(axis)]->v;
        // 1 / z falls as log z rises.
        line.own.row(axis) += factor * Component(force, axis) / s.z * p.z.v;
      }
      const Line* before =
          k > 0 ? &lines_[first_line_[i] + static_cast<std::size_t>(k) - 1] : nullptr;
      const Vec3d row =
          Whitening(k) * (before == nullptr ? line.error : line.error - rho * before->error);
      line.weight = {RobustWeight(Term::kAcceleration, row.x),
                     RobustWeight(Term::kAcceleration, row.y),
                     RobustWeight(Term::kAcceleration, row.z)};
    }
  }
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    batch_[i].SetZero();
    ForEachRow(model_, birds_[i], shared_, true, [&](Term term, const ResidualRow& row) {
      if (term != Term::kAcceleration) batch_[i].Add(row, RobustWeight(term, row.residual));
    });
    blocks_[i] = batch_[i];
  }
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    AddOwnRows(i);
    for (int k = 0; k < birds_[i].knots; ++k) AddNeighbourRows(i, k);
  }
}

// What the rows of one animal say about itself.
void CoupledFlock::AddOwnRows(std::size_t bird) {
  const double rho = noise.Correlation(model_.knot_interval);
  for (int k = 0; k < birds_[bird].knots; ++k) {
    const Line& line = lines_[first_line_[bird] + static_cast<std::size_t>(k)];
    const double whitening = Whitening(k);
    for (int axis = 0; axis < 3; ++axis) {
      ResidualRow row;
      row.first = 3 * std::max(0, k - 1);
      const std::size_t here = k > 0 ? 3 : 0;
      for (std::size_t a = 0; a < 9; ++a) {
        const auto column = static_cast<Eigen::Index>(a);
        if (k > 0) row.path[a] -= rho * whitening * (&line - 1)->own(axis, column);
        row.path[a + here] += whitening * line.own(axis, column);
      }
      blocks_[bird].Add(row, Component(line.weight, axis));
    }
  }
}

// What the row of one animal that ends at `knot` says about each of its neighbours by itself.
void CoupledFlock::AddNeighbourRows(std::size_t bird, int knot) {
  const double rho = noise.Correlation(model_.knot_interval);
  const std::size_t at = first_line_[bird] + static_cast<std::size_t>(knot);
  const double whitening = Whitening(knot);
  static const std::vector<int> kNobody;
  const std::vector<int>& now = neighbours_[at];
  const std::vector<int>& before = knot > 0 ? neighbours_[at - 1] : kNobody;
  std::size_t a = 0, b = 0;
  while (a < now.size() || b < before.size()) {
    const int end = std::numeric_limits<int>::max();
    const int j = std::min(a < now.size() ? now[a] : end, b < before.size() ? before[b] : end);
    const auto other = static_cast<std::size_t>(j);
    const int other_knot = birds_[bird].first_knot + knot - birds_[other].first_knot;
    const std::size_t other_line = first_line_[other] + static_cast<std::size_t>(other_knot);
    const int first = std::max(0, other_knot - 1);
    Eigen::Matrix<double, 3, 12> derivative = Eigen::Matrix<double, 3, 12>::Zero();
    if (a < now.size() && now[a] == j) {
      derivative.middleCols(3 * (other_knot - first), 9) +=
          lines_[at].by[a] * lines_[other_line].state;
      ++a;
    }
    if (b < before.size() && before[b] == j) {
      derivative.leftCols(9) -= rho * lines_[at - 1].by[b] * lines_[other_line - 1].state;
      ++b;
    }
    for (int axis = 0; axis < 3; ++axis) {
      ResidualRow row;
      row.first = 3 * first;
      for (int c = 0; c < 12; ++c) {
        row.path[static_cast<std::size_t>(c)] = whitening * derivative(axis, c);
      }
      blocks_[other].Add(row, Component(lines_[at].weight, axis));
    }
  }
}

void CoupledFlock::AddDynamics(const Eigen::VectorXd* x, Eigen::VectorXd* y) const {
  const double rho = noise.Correlation(model_.knot_interval);
  std::vector<Eigen::Matrix<double, 6, 1>> moved(lines_.size()), pulls(lines_.size());
  std::vector<Vector3> errors(lines_.size());
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    for (int k = 0; k < birds_[i].knots; ++k) {
      const std::size_t at = first_line_[i] + static_cast<std::size_t>(k);
      pulls[at].setZero();
      if (x == nullptr) {
        errors[at] = AsEigen(lines_[at].error);
        continue;
      }
      const auto path = x->segment<9>(offset_[i] + 3 * k);
      moved[at] = lines_[at].state * path;
      errors[at] = lines_[at].own * path;
    }
  }
  const auto line_of = [&](int j, std::size_t i, int k) {
    const auto other = static_cast<std::size_t>(j);
    return first_line_[other] +
           static_cast<std::size_t>(birds_[i].first_knot + k - birds_[other].first_knot);
  };
  if (x != nullptr) {
    for (std::size_t i = 0; i < birds_.size(); ++i) {
      for (int k = 0; k < birds_[i].knots; ++k) {
        const std::size_t at = first_line_[i] + static_cast<std::size_t>(k);
        for (std::size_t n = 0; n < neighbours_[at].size(); ++n) {
          errors[at].noalias() += lines_[at].by[n] * moved[line_of(neighbours_[at][n], i, k)];
        }
      }
    }
  }
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    Vector3 next = Vector3::Zero();  // of the row that begins here, by the error here
    for (int k = birds_[i].knots - 1; k >= 0; --k) {
      const std::size_t at = first_line_[i] + static_cast<std::size_t>(k);
      const double whitening = Whitening(k);
      Vector3 row = errors[at];
      if (k > 0) row -= rho * errors[at - 1];
      row = (whitening * whitening) * row.cwiseProduct(AsEigen(lines_[at].weight));
      const Vector3 by_error = row + next;
      next = -rho * row;
      y->segment<9>(offset_[i] + 3 * k).noalias() += lines_[at].own.transpose() * by_error;
      for (std::size_t n = 0; n < neighbours_[at].size(); ++n) {
        pulls[line_of(neighbours_[at][n], i, k)].noalias() +=
            lines_[at].by[n].transpose() * by_error;
      }
    }
  }
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    for (int k = 0; k < birds_[i].knots; ++k) {
      const std::size_t at = first_line_[i] + static_cast<std::size_t>(k);
      y->segment<9>(offset_[i] + 3 * k).noalias() += lines_[at].state.transpose() * pulls[at];
    }
  }
}

Eigen::VectorXd CoupledFlock::Gradient() {
  Linearize();
  const Eigen::Index size = model_.shared();
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(offset_.back() + size);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd of_shared = Eigen::VectorXd::Zero(size);
  SharedPriors(model_, shared_, &matrix, &of_shared);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Eigen::Index own = offset_[i + 1] - offset_[i];
    gradient.segment(offset_[i], own) += batch_[i].gradient().head(own);
    of_shared += batch_[i].gradient().tail(size);
  }
  gradient.tail(size) = of_shared;
  AddDynamics(nullptr, &gradient);
  return gradient;
}

}  // namespace flocklift::internal
