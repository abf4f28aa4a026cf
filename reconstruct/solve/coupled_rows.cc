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

namespace flocklift::internal {
namespace {

using Jet9 = ceres::Jet<double, 9>;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

int CoupledFlock::BorderOf(std::size_t bird, int index) const {
  return index < kOwnUnknowns ? kOwnUnknowns * place_[bird] + index
                              : FlockBorder() + index - kOwnUnknowns;
}

void CoupledFlock::AddBatchRow(std::size_t bird, const ResidualRow& row, double weight) {
  const int first = row.first / 3;
  const int count = 3 * std::min(4, birds_[bird].knots + 2 - first);
  for (int a = 0; a < count; ++a) {
    const double scaled = weight * row.path[Index(a)];
    if (scaled == 0) continue;
    const int time = birds_[bird].first_knot + first + a / 3;
    const int at = column_[bird][Index(first + a / 3)] + a % 3;
    for (int b = 0; b <= a; ++b) {
      const int other = column_[bird][Index(first + b / 3)] + b % 3;
      system_.Block(time, a / 3 - b / 3)(at, other) += scaled * row.path[Index(b)];
    }
    system_.Gradient(time)[at] += scaled * row.residual;
    for (int c = 0; c < row.border_count; ++c) {
      const auto [index, derivative] = row.border[Index(c)];
      system_.ToBorder(time)(at, BorderOf(bird, index)) += scaled * derivative;
    }
  }
  for (int c = 0; c < row.border_count; ++c) {
    const auto [index, derivative] = row.border[Index(c)];
    const int i = BorderOf(bird, index);
    system_.BorderGradient()[i] += weight * derivative * row.residual;
    for (int d = 0; d < row.border_count; ++d) {
      const auto [other, by] = row.border[Index(d)];
      system_.Corner()(i, BorderOf(bird, other)) += weight * derivative * by;
    }
  }
}

void CoupledFlock::LinearizeLine(std::size_t bird, int knot, const std::vector<Knot>& states) {
  const int time = birds_[bird].first_knot + knot;
  const std::size_t at = first_line_[bird] + Index(knot);
  Line& line = lines_[at];
  const std::vector<Offset> offsets = OffsetsOf(bird, knot, states);
  std::vector<Matrix36> by(offsets.size());
  PairUnknownsMatrix by_pair;
  SelfDerivatives self;
  const Knot& s = states[at];
  const Vec3d force = PairForce(forces, offsets, by.data(), &by_pair) +
                      SelfForce(forces, birds_[bird].own[kOwnLogSpeed], time * model_.knot_interval,
                                s.x, s.v, &self);
  const double factor = birds_[bird].reference_depth / s.z;
  line.error = factor * (s.a - force);
  Matrix36 by_own = self.by_state;
  line.by.resize(by.size());
  for (std::size_t n = 0; n < by.size(); ++n) {
    by_own -= by[n];
    line.by[n].noalias() = -factor * by[n] * lines_[LineOf(neighbours_[at][n], time)].state;
  }
  line.own.noalias() -= factor * by_own * line.state;
  // 1 / z falls as log z, (1, 4, 1) / 6 of three control points, rises.
  for (int axis = 0; axis < 3; ++axis) {
    for (int c = 0; c < 3; ++c) {
      line.own(axis, 3 * c + 2) += factor * Component(force, axis) * (c == 1 ? 4.0 : 1.0) / 6;
    }
  }
  line.by_log_speed = -factor * self.by_log_speed;
  line.by_forces << -factor * by_pair, -factor * self.by_unknowns;
  line.by_target = -factor * self.by_target;
}

void CoupledFlock::Linearize() {
  const std::vector<Knot> states = States();
  const double rate = 1 / model_.knot_interval;
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Bird& bird = birds_[i];
    for (int k = 0; k < bird.knots; ++k) {
      Line& line = lines_[first_line_[i] + Index(k)];
      std::array<Jet9, 9> path;
      for (int a = 0; a < 9; ++a) path[Index(a)] = Jet9(bird.path[Index(3 * k + a)], a);
      const PathPoint<Jet9> p = PointOf(path.data(), rate, CameraAt(bird, k));
      const std::array<const Jet9*, 6> parts = {&p.x.x, &p.x.y, &p.x.z, &p.v.x, &p.v.y, &p.v.z};
      for (int a = 0; a < 6; ++a) line.state.row(a) = parts[Index(a)]->v;
      const std::array<const Jet9*, 3> a_over_z = {&p.a_over_z.x, &p.a_over_z.y, &p.a_over_z.z};
      for (int axis = 0; axis < 3; ++axis) {
        line.own.row(axis) = bird.reference_depth * a_over_z[Index(axis)]->v;
      }
    }
  }
  system_.SetZero();
  Eigen::MatrixXd priors = Eigen::MatrixXd::Zero(model_.shared(), model_.shared());
  Eigen::VectorXd of_priors = Eigen::VectorXd::Zero(model_.shared());
  SharedPriors(model_, shared_, &priors, &of_priors);
  system_.Corner().block(FlockBorder(), FlockBorder(), model_.shared(), model_.shared()) = priors;
  system_.BorderGradient().segment(FlockBorder(), model_.shared()) = of_priors;
  ForcePriors(&system_.Corner(), &system_.BorderGradient());
  const double rho = noise.Correlation(model_.knot_interval);
  for (const int moving : moving_) {
    const auto i = static_cast<std::size_t>(moving);
    ForEachRow(model_, birds_[i], shared_, true, [&](Term term, const ResidualRow& row) {
      if (term != Term::kAcceleration) AddBatchRow(i, row, RobustWeight(term, row.residual));
    });
    for (int k = 0; k < birds_[i].knots; ++k) LinearizeLine(i, k, states);
  }
  // By time, so that the blocks that are added to stay in the processor's caches.
  for (std::size_t time = 0; time < present_.size(); ++time) {
    for (const int animal : present_[time]) {
      if (!Moves(animal)) continue;
      const auto i = static_cast<std::size_t>(animal);
      const int k = static_cast<int>(time) - birds_[i].first_knot;
      Line& line = lines_[first_line_[i] + Index(k)];
      const double whitening = Whitening(k);
      const Vec3d row = whitening * (k == 0 ? line.error : line.error - rho * (&line - 1)->error);
      line.weight = {RobustWeight(Term::kAcceleration, row.x),
                     RobustWeight(Term::kAcceleration, row.y),
                     RobustWeight(Term::kAcceleration, row.z)};
      AddRows(RowsOf(i, k, whitening, k == 0 ? 0 : rho), row, line.weight);
    }
  }
  if (flock_is_free) return;
  constexpr double kFixed = 1e15;
  system_.Corner().diagonal().tail(system_.border() - FlockBorder()).array() += kFixed;
}

CoupledFlock::Rows CoupledFlock::RowsOf(std::size_t bird, int knot, double factor,
                                        double rho) const {
  const int time = birds_[bird].first_knot + knot;
  const std::size_t here = first_line_[bird] + Index(knot);
  const int lines = rho != 0 ? 2 : 1;
  Rows rows;
  rows.first_time = time + 1 - lines;
  // All that move and are heard in either line.
  std::vector<int> heard = {static_cast<int>(bird)};
  for (int l = 0; l < lines; ++l) {
    const std::vector<int>& list = neighbours_[here - Index(l)];
    heard.insert(heard.end(), list.begin(), list.end());
  }
  std::erase_if(heard, [this](int j) { return !Moves(j); });
  std::sort(heard.begin(), heard.end());
  heard.erase(std::unique(heard.begin(), heard.end()), heard.end());
  using Derivative = Eigen::Matrix<double, 3, 12>;
  std::vector<Derivative> by(heard.size(), Derivative::Zero());
  const auto by_of = [&](int j) -> Derivative& {
    return by[Index(
        static_cast<int>(std::lower_bound(heard.begin(), heard.end(), j) - heard.begin()))];
  };
  rows.by_border = Eigen::MatrixXd::Zero(3, 1 + forces.size());
  for (int l = 0; l < lines; ++l) {
    const double share = l == 0 ? factor : -factor * rho;
    const Line& line = lines_[here - Index(l)];
    const int offset = 3 * (lines - 1 - l);
    by_of(static_cast<int>(bird)).middleCols<9>(offset) += share * line.own;
    const std::vector<int>& neighbours = neighbours_[here - Index(l)];
    for (std::size_t n = 0; n < neighbours.size(); ++n) {
      if (Moves(neighbours[n])) by_of(neighbours[n]).middleCols<9>(offset) += share * line.by[n];
    }
    rows.by_border.col(0) += share * line.by_log_speed;
    rows.by_border.middleCols<kForceScalars>(1) += share * line.by_forces;
    const FlockForces::Share target = forces.ShareAt((time - l) * model_.knot_interval);
    const int first = 1 + kForceScalars + 3 * target.knot;
    rows.by_border.middleCols<3>(first) += share * (1 - target.next) * line.by_target;
    rows.by_border.middleCols<3>(first + 3) += share * target.next * line.by_target;
  }
  for (int c = 0; c < 2 + lines; ++c) {
    auto& matrix = rows.by[Index(c)];
    matrix.resize(3, 3 * static_cast<Eigen::Index>(heard.size()));
    Eigen::Index at = 0;
    for (std::size_t n = 0; n < heard.size(); ++n) {
      const std::size_t other = Index(heard[n]);
      const int control = rows.first_time + c - birds_[other].first_knot;
      // One that is there at one of the two knots only has no control points beyond.
      if (control < 0 || control >= static_cast<int>(column_[other].size())) continue;
      rows.columns[Index(c)].push_back(column_[other][Index(control)]);
      matrix.middleCols<3>(at) = by[n].middleCols<3>(3 * c);
      at += 3;
    }
    matrix.conservativeResize(3, at);
  }
  rows.border.push_back(BorderOf(bird, kOwnLogSpeed));
  for (int k = 0; k < forces.size(); ++k) rows.border.push_back(ForceBorder() + k);
  return rows;
}

namespace {

// Columns of animals that follow one another: `size` of them from `at` on, in the rows from `from`
// on.
struct Run {
  int from, at, size;
};

std::vector<Run> RunsOf(const std::vector<int>& columns) {
  std::vector<Run> runs;
  for (std::size_t n = 0; n < columns.size(); ++n) {
    if (runs.empty() || columns[n] != runs.back().at + runs.back().size) {
      runs.push_back({3 * static_cast<int>(n), columns[n], 0});
    }
    runs.back().size += 3;
  }
  return runs;
}

}  // namespace

void CoupledFlock::AddRows(const Rows& rows, const Vec3d& residual, const Vec3d& weight) {
  const Eigen::Vector3d w(weight.x, weight.y, weight.z);
  const Eigen::Vector3d r(weight.x * residual.x, weight.y * residual.y, weight.z * residual.z);
  const Eigen::Index first = ForceBorder(), count = forces.size();
  const auto of_forces = rows.by_border.rightCols(count);
  for (int c = 0; c < TimeSystem::kSpan; ++c) {
    const int time = rows.first_time + c;
    const auto& by = rows.by[Index(c)];
    if (by.cols() == 0) continue;
    const Eigen::Matrix<double, Eigen::Dynamic, 3> weighted = by.transpose() * w.asDiagonal();
    const Eigen::VectorXd pulled = by.transpose() * r;
    // What stands side by side in the block is added at once.
    for (const Run& run : RunsOf(rows.columns[Index(c)])) {
      const auto mine = weighted.middleRows(run.from, run.size);
      for (int d = 0; d <= c; ++d) {
        const std::vector<int>& others = rows.columns[Index(c - d)];
        Eigen::MatrixXd& block = system_.Block(time, d);
        for (std::size_t m = 0; m < others.size(); ++m) {
          if (d == 0 && others[m] >= run.at + run.size) break;  // above the diagonal
          const Eigen::Matrix3d other =
              rows.by[Index(c - d)].middleCols<3>(3 * static_cast<Eigen::Index>(m));
          block.middleCols<3>(others[m]).middleRows(run.at, run.size) += mine.lazyProduct(other);
        }
      }
      system_.Gradient(time).segment(run.at, run.size) += pulled.segment(run.from, run.size);
      Eigen::MatrixXd& border = system_.ToBorder(time);
      border.col(rows.border[0]).segment(run.at, run.size) +=
          mine.lazyProduct(rows.by_border.col(0));
      border.middleRows(run.at, run.size).middleCols(first, count) += mine.lazyProduct(of_forces);
    }
  }
  const Eigen::MatrixXd product = rows.by_border.transpose() * w.asDiagonal() * rows.by_border;
  const Eigen::VectorXd gradient = rows.by_border.transpose() * r;
  for (std::size_t a = 0; a < rows.border.size(); ++a) {
    const auto i = static_cast<Eigen::Index>(a);
    system_.BorderGradient()[rows.border[a]] += gradient[i];
    for (std::size_t b = 0; b < rows.border.size(); ++b) {
      system_.Corner()(rows.border[a], rows.border[b]) += product(i, static_cast<Eigen::Index>(b));
    }
  }
}

Eigen::VectorXd CoupledFlock::Gradient() {
  Linearize();
  Eigen::Index size = system_.border();
  for (const int i : moving_) size += birds_[Index(i)].unknowns();
  Eigen::VectorXd gradient(size);
  Eigen::Index at = 0;
  for (const int moving : moving_) {
    const std::size_t i = Index(moving);
    for (int c = 0; c < birds_[i].knots + 2; ++c) {
      gradient.segment<3>(at) =
          system_.Gradient(birds_[i].first_knot + c).segment<3>(column_[i][Index(c)]);
      at += 3;
    }
    for (int a = 0; a < kOwnUnknowns; ++a) {
      gradient[at++] = system_.BorderGradient()[BorderOf(i, a)];
    }
  }
  gradient.tail(size - at) = system_.BorderGradient().tail(size - at);
  return gradient;
}

}  // namespace flocklift::internal
