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

// What the force says of neighbours' (x, v), and of errors to them.
template <int Count>
Eigen::Matrix<double, 3, Count> Told(const ByOffset& by,
                                     const Eigen::Matrix<double, 6, Count>& state) {
  const auto dx = state.template topRows<3>();
  return by.x * dx + by.v * state.template bottomRows<3>() +
         by.across * (by.along.transpose() * dx);
}
template <int Count>
void Tell(const ByOffset& by, const Eigen::Matrix<double, 3, Count>& error,
          Eigen::Matrix<double, 6, Count>* state) {
  state->template topRows<3>() += by.x * error + by.along * (by.across.transpose() * error);
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
  ForEachLine([&](std::size_t i, int k, std::size_t at) {
    const Bird& bird = birds_[i];
    const Line& line = lines_[at];
    const Eigen::Matrix<double, 9, Count> path = x.template middleRows<9>(place_[i] + 3 * k);
    states[at] = line.state.lazyProduct(path);
    const FlockForces::Share target = forces.ShareAt((bird.first_knot + k) * model_.knot_interval);
    const Eigen::Index knot = first_force + kForceScalars + 3 * target.knot;
    const Eigen::Matrix<double, 3, Count> goal =
        (1 - target.next) * x.template middleRows<3>(knot) +
        target.next * x.template middleRows<3>(knot + 3);
    auto& change = (*own)[at];
    change = line.own.lazyProduct(path);
    change += line.by_forces.lazyProduct(scalars);
    change += line.by_target.lazyProduct(goal);
    change.noalias() += line.by_log_speed * x.row(place_[i] + bird.unknowns() + kOwnLogSpeed);
  });
  std::size_t edge = 0, inside = 0;
  for (std::size_t at = 0; at < lines_.size(); ++at) {
    const Line& line = lines_[at];
    Eigen::Matrix<double, 3, Count> sum = Eigen::Matrix<double, 3, Count>::Zero();
    for (const auto& [end, by_x, by_v] : line.inside) {
      State all = State::Zero();
      for (; inside < end; ++inside) all += states[inside_[inside]];
      sum += by_x * all.template topRows<3>() + by_v * all.template bottomRows<3>();
    }
    for (; edge < line.edge_end; ++edge) sum += Told<Count>(by_edge_[edge], states[edge_[edge]]);
    (*heard)[at] = sum;
  }
}

// A^T W A e, A the whitening of one animal's errors.
template <int Count>
void CoupledFlock::Weigh(Errors<Count>* errors) const {
  const MarkovWhitening whitening = Whitening();
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    Eigen::Matrix<double, 3, Count> before = Eigen::Matrix<double, 3, Count>::Zero();
    for (int k = 0; k < birds_[i].knots; ++k) {
      const std::size_t at = LineOf(i, k);
      const double square = whitening.At(k) * whitening.At(k);
      const Eigen::Matrix<double, 3, Count> error = (*errors)[at];
      (*errors)[at] = (square * lines_[at].weight).asDiagonal() * (error - whitening.rho * before);
      if (k > 0) (*errors)[LineOf(i, k - 1)] -= whitening.rho * (*errors)[at];
      before = error;
    }
  }
}

template <int Count>
void CoupledFlock::PullOwn(const Errors<Count>& errors, Columns<Count>* y) const {
  const Eigen::Index first_force = place_.back() + model_.shared();
  ForEachLine([&](std::size_t i, int k, std::size_t at) {
    const Bird& bird = birds_[i];
    const Line& line = lines_[at];
    const auto& error = errors[at];
    y->template middleRows<9>(place_[i] + 3 * k) += line.own.transpose().lazyProduct(error);
    y->row(place_[i] + bird.unknowns() + kOwnLogSpeed).noalias() +=
        line.by_log_speed.transpose() * error;
    y->template middleRows<kForceScalars>(first_force) +=
        line.by_forces.transpose().lazyProduct(error);
    const FlockForces::Share target = forces.ShareAt((bird.first_knot + k) * model_.knot_interval);
    const Eigen::Index knot = first_force + kForceScalars + 3 * target.knot;
    const Eigen::Matrix<double, 3, Count> goal = line.by_target.transpose() * error;
    y->template middleRows<3>(knot) += (1 - target.next) * goal;
    y->template middleRows<3>(knot + 3) += target.next * goal;
  });
}

template <int Count>
void CoupledFlock::PullHeard(const Errors<Count>& errors, Columns<Count>* y) const {
  using State = Eigen::Matrix<double, 6, Count>;
  std::vector<State> states(lines_.size(), State::Zero());
  std::size_t edge = 0, inside = 0;
  for (std::size_t at = 0; at < lines_.size(); ++at) {
    const Line& line = lines_[at];
    for (const auto& [end, by_x, by_v] : line.inside) {
      State all;
      all << by_x * errors[at], by_v * errors[at];
      for (; inside < end; ++inside) states[inside_[inside]] += all;
    }
    for (; edge < line.edge_end; ++edge) {
      Tell<Count>(by_edge_[edge], errors[at], &states[edge_[edge]]);
    }
  }
  ForEachLine([&](std::size_t i, int k, std::size_t at) {
    y->template middleRows<9>(place_[i] + 3 * k) +=
        lines_[at].state.transpose().lazyProduct(states[at]);
  });
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
