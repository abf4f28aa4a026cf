// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/one_animal.h"

#include <algorithm>

#include "reconstruct/solve/coupled_point.h"

namespace flocklift::internal {
namespace {

constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-7, kMostDamping = 1e6;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

Eigen::Vector3d AsEigen(const Vec3d& v) { return {v.x, v.y, v.z}; }

Eigen::Vector3d Weights(const Eigen::Vector3d& residual) {
  const auto weight = [](double r) { return RobustWeight(Term::kAcceleration, r); };
  return residual.unaryExpr(weight);
}

}  // namespace

OneAnimal::OneAnimal(CoupledFlock* flock)
    : flock_(*flock),
      reach_(flock->forces.Reach()),
      pairs_(flock->forces),
      states_(flock->States()),
      rest_(states_.size()),
      factor_(states_.size()),
      errors_(states_.size()),
      without_(states_.size()),
      hears_(states_.size()),
      by_(states_.size()) {
  std::size_t lines = 0;
  for (const std::vector<std::size_t>& present : flock_.present_) {
    first_line_.push_back(lines);
    lines += present.size();
  }
  flock_.ForEachLine([this](std::size_t i, int k, std::size_t line) {
    PairForce::Sums sums;
    ForEachOther(flock_.birds_[i].first_knot + k, i, [&](std::size_t other, std::size_t) {
      const Offset offset = From(line, other);
      if (Hears(offset)) sums += pairs_.SharesOf(offset);
    });
    rest_[line] = states_[line].a - SelfForceAt(i, k, nullptr);
    factor_[line] = flock_.birds_[i].reference_depth / states_[line].z;
    errors_[line] = factor_[line] * (rest_[line] - pairs_.ForceOf(sums));
  });
}

Vec3d OneAnimal::SelfForceAt(std::size_t animal, int knot, SelfDerivatives* derivatives) const {
  const Bird& b = flock_.birds_[animal];
  const Knot& s = states_[flock_.LineOf(animal, knot)];
  const double time = (b.first_knot + knot) * flock_.model_.knot_interval;
  return SelfForce(flock_.forces, b.own[kOwnLogSpeed], time, s.x, s.v, derivatives);
}

void OneAnimal::Choose(std::size_t animal) {
  animal_ = animal;
  std::fill(hears_.begin(), hears_.end(), 0);
  lines_.resize(Index(bird().knots));
  system_ = ArrowSystem(bird().unknowns(), kOwnUnknowns, flock_.model_.shared());
  for (int k = 0; k < bird().knots; ++k) {
    const int time = bird().first_knot + k;
    ForEachOther(time, animal_, [&](std::size_t line, std::size_t j) {
      PairForce::Sums& sums = without_[line] = {};
      ForEachOther(time, j, [&](std::size_t other, std::size_t i) {
        const Offset offset = From(line, other);
        if (i != animal_ && Hears(offset)) sums += pairs_.SharesOf(offset);
      });
    });
  }
  Update();
}

void OneAnimal::Put(const Bird& bird) {
  flock_.birds_[animal_] = bird;
  Update();
}

void OneAnimal::Hear(int knot) {
  heard_.clear();
  const std::size_t own = flock_.LineOf(animal_, knot);
  ForEachOther(bird().first_knot + knot, animal_, [&](std::size_t other, std::size_t) {
    const Offset offset = From(own, other);
    if (Hears(offset)) heard_.push_back(offset);
  });
}

void OneAnimal::Update() {
  const double rate = 1 / flock_.model_.knot_interval;
  for (int k = 0; k < bird().knots; ++k) {
    const auto p = PointOf(&bird().path[3 * Index(k)], rate, flock_.CameraAt(bird(), k));
    const std::size_t own = flock_.LineOf(animal_, k);
    states_[own] = {p.x, p.v, p.z * p.a_over_z, p.z};
    factor_[own] = bird().reference_depth / p.z;
    rest_[own] = states_[own].a - SelfForceAt(animal_, k, nullptr);
    PairForce::Sums sums;
    ForEachOther(bird().first_knot + k, animal_, [&](std::size_t line, std::size_t) {
      const Offset offset = From(line, own);
      const bool hears = Hears(offset);
      if (hears) sums += pairs_.SharesOf({-offset.dx, -offset.dv});
      if (!hears && !hears_[line]) return;
      PairForce::Sums of_line = without_[line];
      if (hears) of_line += pairs_.SharesOf(offset);
      errors_[line] = factor_[line] * (rest_[line] - pairs_.ForceOf(of_line));
      hears_[line] = hears;
    });
    errors_[own] = factor_[own] * (rest_[own] - pairs_.ForceOf(sums));
  }
}

double OneAnimal::Cost() const {
  const MarkovWhitening whitening = flock_.Whitening();
  double cost = CostOf(flock_.model_, bird(), flock_.shared_, RowKind::kNoAccelerations);
  for (std::size_t i = 0; i < flock_.birds_.size(); ++i) {
    Vec3d before;
    for (int k = 0; k < flock_.birds_[i].knots; ++k) {
      const Vec3d& error = errors_[flock_.LineOf(i, k)];
      const Vec3d row = whitening.At(k) * (k == 0 ? error : error - whitening.rho * before);
      for (int axis = 0; axis < 3; ++axis) {
        cost += RobustCost(Term::kAcceleration, Component(row, axis));
      }
      before = error;
    }
  }
  return cost;
}

void OneAnimal::Linearize() {
  system_.SetZero();
  const auto add = [&](Term term, const ResidualRow& row) {
    system_.Add(row, RobustWeight(term, row.residual));
  };
  ForEachRow(flock_.model_, bird(), flock_.shared_, true, add, RowKind::kNoAccelerations);
  LinearizeOwn();
  LinearizeOthers();
}

void OneAnimal::LinearizeOwn() {
  const MarkovWhitening whitening = flock_.Whitening();
  PairUnknownsMatrix unused;
  for (int k = 0; k < bird().knots; ++k) {
    Line& line = lines_[Index(k)];
    flock_.LinearizeState(animal_, k, &line);
    Hear(k);
    by_heard_.resize(heard_.size());
    SelfDerivatives self;
    const Vec3d force = pairs_(heard_, by_heard_.data(), &unused) + SelfForceAt(animal_, k, &self);
    flock_.LinearizeError(animal_, states_[flock_.LineOf(animal_, k)], force, by_heard_, self,
                          &line);
    const double now = whitening.At(k), past = now * whitening.rho;
    ArrowSystem::Rows rows;
    rows.first = 3 * std::max(k - 1, 0);
    rows.residual = now * AsEigen(line.error);
    rows.path.setZero();
    rows.path.middleCols<9>(k > 0 ? 3 : 0) = now * line.own;
    rows.own = kOwnLogSpeed;
    rows.by_own = now * line.by_log_speed;
    if (k > 0) {
      const Line& before = lines_[Index(k - 1)];
      rows.residual -= past * AsEigen(before.error);
      rows.path.leftCols<9>() -= past * before.own;
      rows.by_own -= past * before.by_log_speed;
    }
    system_.Add(rows, Weights(rows.residual));
  }
}

// Whitened rows of others by this one's states at two knots, summed, and then by its path.
void OneAnimal::LinearizeOthers() {
  const MarkovWhitening whitening = flock_.Whitening();
  const int first = bird().first_knot, knots = bird().knots;
  for (int k = 0; k < knots; ++k) {
    const std::size_t own = flock_.LineOf(animal_, k);
    ForEachOther(first + k, animal_, [&](std::size_t line, std::size_t) {
      if (!hears_[line]) return;
      const Offset offset = From(line, own);
      PairForce::Sums sums = without_[line];
      sums += pairs_.SharesOf(offset);
      by_[line] = pairs_.ByOne(sums, offset);
    });
  }
  // Also the rows that end at the knot after its last.
  const int end = std::min(knots + 1, static_cast<int>(flock_.present_.size()) - first);
  for (int k = 0; k < end; ++k) {
    ArrowSystem::Square square = ArrowSystem::Square::Zero();
    ArrowSystem::Pull pull = ArrowSystem::Pull::Zero();
    ForEachOther(first + k, animal_, [&](std::size_t line, std::size_t j) {
      const int knot = first + k - flock_.birds_[j].first_knot;
      const bool follows = knot > 0;
      const std::size_t before = follows ? flock_.LineOf(j, knot - 1) : line;
      const bool now = k < knots && hears_[line], then = k > 0 && follows && hears_[before];
      if (!now && !then) return;
      const double present = whitening.At(knot), past = present * whitening.rho;
      Eigen::Vector3d residual = present * AsEigen(errors_[line]);
      if (follows) residual -= past * AsEigen(errors_[before]);
      Eigen::Matrix<double, 3, 12> rows = Eigen::Matrix<double, 3, 12>::Zero();
      const auto by = [&](std::size_t at, double share, int column) {
        const double factor = -share * factor_[at];
        rows.middleCols<3>(column) = factor * by_[at].ByPosition();
        rows.middleCols<3>(column + 3).diagonal().setConstant(factor * by_[at].v);
      };
      if (then) by(before, -past, 0);
      if (now) by(line, present, 6);
      const Eigen::Matrix<double, 12, 3> weighted =
          rows.transpose() * Weights(residual).asDiagonal();
      square += weighted.lazyProduct(rows);
      pull.noalias() += weighted * residual;
    });
    ArrowSystem::Square by_path = ArrowSystem::Square::Zero();  // of the states
    if (k > 0) by_path.block<6, 9>(0, 0) = lines_[Index(k - 1)].state;
    if (k < knots) by_path.block<6, 9>(6, k > 0 ? 3 : 0) = lines_[Index(k)].state;
    system_.Add(3 * std::max(k - 1, 0), by_path.transpose() * square * by_path,
                by_path.transpose() * pull);
  }
}

double OneAnimal::Minimize(int max_iterations) {
  constexpr double kEnough = 0.1;  // fall of the cost that counts
  const Eigen::Index shared = flock_.model_.shared();
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(shared);
  double cost = Cost(), damping = kFirstDamping;
  bool linearized = false;
  flock_.model_.CountIteration();
  for (int iteration = 0; iteration < max_iterations && damping < kMostDamping; ++iteration) {
    if (!linearized) Linearize();
    linearized = true;
    Eigen::MatrixXd unused_matrix = Eigen::MatrixXd::Zero(shared, shared);
    Eigen::VectorXd unused = still;
    if (!system_.Reduce(damping, &unused_matrix, &unused)) {
      damping *= 10;
      continue;
    }
    const Eigen::VectorXd step = system_.BackSubstitute(still);
    const Bird before = bird();
    Bird next = before;
    for (int a = 0; a < next.unknowns(); ++a) next.path[Index(a)] += step[a];
    for (int a = 0; a < kOwnUnknowns; ++a) next.own[Index(a)] += step[next.unknowns() + a];
    Put(next);
    const double candidate = Cost();
    if (candidate < cost) {
      const bool enough = cost - candidate < kEnough;
      cost = candidate;
      damping = std::max(0.1 * damping, kLeastDamping);
      linearized = false;
      if (enough) break;
    } else {
      Put(before);
      damping *= 10;
    }
  }
  return cost;
}

}  // namespace flocklift::internal
