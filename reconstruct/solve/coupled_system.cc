// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The linear system of the flock with forces, by what it does to vectors. With J = J_o + J_h, the
// derivatives of the errors by an animal's own unknowns and by those of the neighbours that it
// hears, and P the animals each for itself (J_o^T W J_o and all that is not force):
//   M x = P x + J_o^T W J_h x + J_h^T W (J_o x + J_h x)
// P, border and all, is the preconditioner: positive definite, and factorised animal by animal.

#include "reconstruct/solve/coupled_flock.h"

namespace flocklift::internal {
namespace {

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

// What the force says of neighbours' (x, v), and of errors to them.
template <int Count>
Eigen::Matrix<double, 3, Count> Told(const ByOffset& by,
                                     const Eigen::Matrix<double, 6, Count>& state) {
  return by.x * state.template topRows<3>() + by.v * state.template bottomRows<3>();
}
template <int Count>
void Tell(const ByOffset& by, const Eigen::Matrix<double, 3, Count>& error,
          Eigen::Matrix<double, 6, Count>* state) {
  state->template topRows<3>().noalias() += by.x.transpose() * error;
  state->template bottomRows<3>() += by.v * error;
}

}  // namespace

template <int Count>
void CoupledFlock::ChangesOf(const Columns<Count>& x, Errors<Count>* own,
                             Errors<Count>* heard) const {
  using State = Eigen::Matrix<double, 6, Count>;
  std::vector<State> states(lines_.size());
  own->resize(lines_.size());
  heard->resize(lines_.size());
  const Eigen::Index first_force = place_.back() + model_.shared();
  const Eigen::Matrix<double, kForceScalars, Count> scalars =
      x.template middleRows<kForceScalars>(first_force);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Bird& bird = birds_[i];
    const Eigen::Matrix<double, 1, Count> log_speed =
        x.row(place_[i] + bird.unknowns() + kOwnLogSpeed);
    for (int k = 0; k < bird.knots; ++k) {
      const std::size_t at = first_line_[i] + Index(k);
      const Line& line = lines_[at];
      const Eigen::Matrix<double, 9, Count> path = x.template middleRows<9>(place_[i] + 3 * k);
      states[at].noalias() = line.state * path;
      const FlockForces::Share target =
          forces.ShareAt((bird.first_knot + k) * model_.knot_interval);
      const Eigen::Index knot = first_force + kForceScalars + 3 * target.knot;
      const Eigen::Matrix<double, 3, Count> goal =
          (1 - target.next) * x.template middleRows<3>(knot) +
          target.next * x.template middleRows<3>(knot + 3);
      auto& change = (*own)[at];
      change.noalias() = line.own * path;
      change.noalias() += line.by_forces * scalars;
      change.noalias() += line.by_target * goal;
      change.noalias() += line.by_log_speed * log_speed;
    }
  }
  std::size_t near = 0, far = 0;
  for (std::size_t at = 0; at < lines_.size(); ++at) {
    const Line& line = lines_[at];
    State all = State::Zero();
    for (; far < line.far_end; ++far) all += states[far_[far]];
    Eigen::Matrix<double, 3, Count> sum = Told<Count>(line.by_far, all);
    for (; near < line.near_end; ++near) sum += Told<Count>(by_near_[near], states[near_[near]]);
    (*heard)[at] = sum;
  }
}

// A^T W A e, A the whitening of one animal's errors.
template <int Count>
void CoupledFlock::Weigh(Errors<Count>* errors) const {
  const double rho = noise.Correlation(model_.knot_interval);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    Eigen::Matrix<double, 3, Count> before = Eigen::Matrix<double, 3, Count>::Zero();
    for (int k = 0; k < birds_[i].knots; ++k) {
      const std::size_t at = first_line_[i] + Index(k);
      const double whitening = Whitening(k) * Whitening(k);
      const Eigen::Matrix<double, 3, Count> error = (*errors)[at];
      (*errors)[at] = (whitening * lines_[at].weight).asDiagonal() * (error - rho * before);
      if (k > 0) (*errors)[at - 1] -= rho * (*errors)[at];
      before = error;
    }
  }
}

template <int Count>
void CoupledFlock::PullOwn(const Errors<Count>& errors, Columns<Count>* y) const {
  const Eigen::Index first_force = place_.back() + model_.shared();
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Bird& bird = birds_[i];
    for (int k = 0; k < bird.knots; ++k) {
      const std::size_t at = first_line_[i] + Index(k);
      const Line& line = lines_[at];
      const auto& error = errors[at];
      y->template middleRows<9>(place_[i] + 3 * k).noalias() += line.own.transpose() * error;
      y->row(place_[i] + bird.unknowns() + kOwnLogSpeed).noalias() +=
          line.by_log_speed.transpose() * error;
      y->template middleRows<kForceScalars>(first_force).noalias() +=
          line.by_forces.transpose() * error;
      const FlockForces::Share target =
          forces.ShareAt((bird.first_knot + k) * model_.knot_interval);
      const Eigen::Index knot = first_force + kForceScalars + 3 * target.knot;
      const Eigen::Matrix<double, 3, Count> goal = line.by_target.transpose() * error;
      y->template middleRows<3>(knot) += (1 - target.next) * goal;
      y->template middleRows<3>(knot + 3) += target.next * goal;
    }
  }
}

template <int Count>
void CoupledFlock::PullHeard(const Errors<Count>& errors, Columns<Count>* y) const {
  using State = Eigen::Matrix<double, 6, Count>;
  std::vector<State> states(lines_.size(), State::Zero());
  std::size_t near = 0, far = 0;
  for (std::size_t at = 0; at < lines_.size(); ++at) {
    const Line& line = lines_[at];
    State all = State::Zero();
    Tell<Count>(line.by_far, errors[at], &all);
    for (; far < line.far_end; ++far) states[far_[far]] += all;
    for (; near < line.near_end; ++near) {
      Tell<Count>(by_near_[near], errors[at], &states[near_[near]]);
    }
  }
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    for (int k = 0; k < birds_[i].knots; ++k) {
      const std::size_t at = first_line_[i] + Index(k);
      y->template middleRows<9>(place_[i] + 3 * k).noalias() +=
          lines_[at].state.transpose() * states[at];
    }
  }
}

template <int Count>
void CoupledFlock::Multiply(const Columns<Count>& x, Columns<Count>* y) const {
  y->setZero(x.rows(), Count);
  const Columns<Count> tail = x.bottomRows(border());
  Columns<Count> of_border = priors_ * tail;
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Eigen::Index size = place_[i + 1] - place_[i];
    animals_[i].Multiply<Count>(x.middleRows(place_[i], size), tail, y->middleRows(place_[i], size),
                                &of_border);
  }
  y->bottomRows(border()) += of_border;
  Errors<Count> own, heard;
  ChangesOf<Count>(x, &own, &heard);
  for (std::size_t at = 0; at < own.size(); ++at) own[at] += heard[at];
  Weigh<Count>(&heard);
  Weigh<Count>(&own);
  PullOwn<Count>(heard, y);
  PullHeard<Count>(own, y);
}

bool CoupledFlock::Factorise(double damping) {
  damping_ = damping;
  Eigen::MatrixXd matrix = priors_;
  for (const ArrowSystem& animal : animals_) {
    matrix.diagonal() += damping * animal.corner().diagonal().tail(border());
  }
  matrix.diagonal() += damping * priors_.diagonal();
  Eigen::VectorXd unused = Eigen::VectorXd::Zero(border());
  for (ArrowSystem& animal : animals_) {
    if (!animal.Reduce(damping, &matrix, &unused)) return false;
  }
  border_factor_.compute(matrix);
  return border_factor_.info() == Eigen::Success;
}

template <int Count>
Columns<Count> CoupledFlock::Solve(const Columns<Count>& b, const GradientStop& stop) const {
  const auto multiply = [this](const Columns<Count>& x, Columns<Count>* y) {
    Multiply<Count>(x, y);
    y->noalias() += (damping_ * diagonal_).asDiagonal() * x;
  };
  const auto precondition = [this](Columns<Count>* x) {
    Columns<Count> tail = x->bottomRows(border());
    for (std::size_t i = 0; i < birds_.size(); ++i) {
      animals_[i].Eliminate<Count>(x->middleRows(place_[i], place_[i + 1] - place_[i]), &tail);
    }
    tail = border_factor_.solve(tail).eval();
    for (std::size_t i = 0; i < birds_.size(); ++i) {
      animals_[i].Substitute<Count>(tail, x->middleRows(place_[i], place_[i + 1] - place_[i]));
    }
    x->bottomRows(border()) = tail;
  };
  return ConjugateGradients(b, stop, multiply, precondition);
}

template void CoupledFlock::Multiply<1>(const Columns<1>&, Columns<1>*) const;
template Columns<1> CoupledFlock::Solve<1>(const Columns<1>&, const GradientStop&) const;
template Columns<8> CoupledFlock::Solve<8>(const Columns<8>&, const GradientStop&) const;
template void CoupledFlock::ChangesOf<8>(const Columns<8>&, Errors<8>*, Errors<8>*) const;
template void CoupledFlock::Weigh<1>(Errors<1>*) const;
template void CoupledFlock::PullHeard<1>(const Errors<1>&, Columns<1>*) const;
template void CoupledFlock::PullOwn<8>(const Errors<8>&, Columns<8>*) const;
template void CoupledFlock::PullHeard<8>(const Errors<8>&, Columns<8>*) const;

}  // namespace flocklift::internal
