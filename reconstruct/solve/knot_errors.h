// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The errors of one animal at its knots, and the unit residuals that successive ones make
// (markov.h): values alone, or with their derivatives by the control points and the border.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_KNOT_ERRORS_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_KNOT_ERRORS_H_

#include <ceres/jet.h>

#include <Eigen/Core>
#include <array>
#include <utility>

#include "reconstruct/cost_functions/markov.h"
#include "reconstruct/cost_functions/path.h"
#include "reconstruct/solve/arrow_system.h"
#include "reconstruct/solve/batch_problem.h"
#include "reconstruct/solve/flock_curve.h"
#include "reconstruct/solve/terms.h"

namespace flocklift::internal {

struct ErrorValue {
  double value = 0;

  void AddTo(double factor, int /*column*/, ResidualRow* row) const {
    row->residual += factor * value;
  }
  void Subtract(const FlockCurve::Share& share, const Eigen::VectorXd& shared) {
    value -= share.weight * shared[share.index];
  }
};

// With derivatives by the three control points around the knot and the border.
struct ErrorSlopes {
  static constexpr int kPathWidth = 9;  // unknowns of three control points
  double value = 0;
  std::array<double, kPathWidth> path{};
  std::array<std::pair<int, double>, 5> border;
  int border_count = 0;

  // The path's in the row from `column` on.
  void AddTo(double factor, int column, ResidualRow* row) const {
    row->residual += factor * value;
    for (int a = 0; a < kPathWidth; ++a) row->path[column + a] += factor * path[a];
    for (int a = 0; a < border_count; ++a) {
      row->AddBorder(border[a].first, factor * border[a].second);
    }
  }
  void Subtract(const FlockCurve::Share& share, const Eigen::VectorXd& shared) {
    value -= share.weight * shared[share.index];
    border[border_count++] = {kOwnUnknowns + share.index, -share.weight};
  }
};

// A scalar that an error depends on beside the path, and its place in the border.
struct BorderScalar {
  double value;
  int place;
};

// Evaluate functors error(state, scalars, errors) for `Size` errors at a knot. The path's state has
// `Orders` times three entries that count: x/z, y/z, log z, their slopes, and their curves.
class ValuesAtKnot {
 public:
  using Error = ErrorValue;
  ValuesAtKnot(const double* control_points, double rate) : q_(StateAtKnot(control_points, rate)) {}

  template <int Size, int Orders, std::size_t Extra, typename Functor>
  std::array<Error, Size> Of(const std::array<BorderScalar, Extra>& extra,
                             const Functor& error) const {
    std::array<double, Extra> x;
    for (std::size_t a = 0; a < Extra; ++a) x[a] = extra[a].value;
    std::array<double, Size> values;
    error(q_, x.data(), values.data());
    std::array<Error, Size> errors;
    for (int a = 0; a < Size; ++a) errors[a].value = values[a];
    return errors;
  }
  Error LogDepth() const { return {q_.l}; }

 private:
  PathState<double> q_;
};

// Derivatives by the few entries of the state are cheaper than by the control points, in which it
// is linear (path.h).
class SlopesAtKnot {
 public:
  using Error = ErrorSlopes;
  SlopesAtKnot(const double* control_points, double rate)
      : q_(StateAtKnot(control_points, rate)), rate_(rate) {}

  template <int Size, int Orders, std::size_t Extra, typename Functor>
  std::array<Error, Size> Of(const std::array<BorderScalar, Extra>& extra,
                             const Functor& error) const {
    constexpr int kState = 3 * Orders, kExtra = static_cast<int>(Extra);
    using Jet = ceres::Jet<double, kState + kExtra>;
    PathState<Jet> state{Jet(q_.x, 0),  Jet(q_.y, 1), Jet(q_.l, 2), Jet(q_.dx, 3), Jet(q_.dy, 4),
                         Jet(q_.dl, 5), Jet(q_.ddx),  Jet(q_.ddy),  Jet(q_.ddl)};
    if constexpr (Orders == 3) {
      state.ddx.v[6] = state.ddy.v[7] = state.ddl.v[8] = 1;
    }
    std::array<Jet, Extra> x;
    for (int a = 0; a < kExtra; ++a) x[a] = Jet(extra[a].value, kState + a);
    std::array<Jet, Size> values;
    error(state, x.data(), values.data());
    const double rate2 = rate_ * rate_;
    const std::array<std::array<double, 3>, 3> of_control = {
        {{1.0 / 6, 4.0 / 6, 1.0 / 6}, {-0.5 * rate_, 0, 0.5 * rate_}, {rate2, -2 * rate2, rate2}}};
    std::array<Error, Size> errors;
    for (int a = 0; a < Size; ++a) {
      errors[a].value = values[a].a;
      for (int order = 0; order < Orders; ++order) {
        for (int b = 0; b < Error::kPathWidth; ++b) {
          errors[a].path[b] += of_control[order][b / 3] * values[a].v[3 * order + b % 3];
        }
      }
      for (int b = 0; b < kExtra; ++b) {
        errors[a].border[b] = {extra[b].place, values[a].v[kState + b]};
      }
      errors[a].border_count = kExtra;
    }
    return errors;
  }
  Error LogDepth() const {
    Error depth;
    depth.value = q_.l;
    depth.path[2] = depth.path[8] = 1.0 / 6;
    depth.path[5] = 4.0 / 6;
    return depth;
  }

 private:
  PathState<double> q_;
  double rate_;
};

// Turns the errors of successive knots into independent unit residuals. A gap starts the process
// afresh.
template <typename Error>
class MarkovRows {
 public:
  MarkovRows(Term term, const MarkovProcess& process, double dt)
      : term_(term), whitening_(process, dt) {}

  void Push(int knot, const Error& error, const RowSink& take) {
    ResidualRow row;
    if (knot == knot_ + 1) {
      row.first = 3 * knot_;
      before_.AddTo(-whitening_.next * whitening_.rho, 0, &row);
      error.AddTo(whitening_.next, 3, &row);
    } else {
      row.first = 3 * knot;
      error.AddTo(whitening_.first, 0, &row);
    }
    take(term_, row);
    before_ = error;
    knot_ = knot;
  }

 private:
  Term term_;
  MarkovWhitening whitening_;
  int knot_ = -2;
  Error before_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_KNOT_ERRORS_H_
