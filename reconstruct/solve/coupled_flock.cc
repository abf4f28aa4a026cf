// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/coupled_flock.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/solve/coupled_point.h"

namespace flocklift::internal {
namespace {

constexpr double kMargin = 2;  // beyond reach, so that a frozen neighbourhood stays whole [m]

}  // namespace

CoupledFlock::CoupledFlock(const BatchModel& model, std::vector<Bird>* birds,
                           Eigen::VectorXd* shared)
    : model_(model), birds_(*birds), shared_(*shared) {
  std::size_t lines = 0;
  Eigen::Index unknowns = 0;
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Bird& bird = birds_[i];
    first_line_.push_back(lines);
    offset_.push_back(unknowns);
    lines += static_cast<std::size_t>(bird.knots);
    unknowns += bird.unknowns() + kOwnUnknowns;
    const std::size_t end = static_cast<std::size_t>(bird.first_knot + bird.knots);
    if (present_.size() < end) present_.resize(end);
    for (int k = 0; k < bird.knots; ++k) {
      present_[static_cast<std::size_t>(bird.first_knot + k)].push_back(i);
    }
    batch_.emplace_back(bird.unknowns(), kOwnUnknowns, model_.shared());
    blocks_.push_back(batch_.back());
  }
  offset_.push_back(unknowns);
  lines_.resize(lines);
  neighbours_.resize(lines);
  forces.up_in_cam = model_.up_in_cam;
  forces.pull.assign(2 + static_cast<std::size_t>(static_cast<double>(present_.size()) *
                                                  model_.knot_interval / kPullKnotTime),
                     {});
  FreezeNeighbours();
}

std::vector<CoupledFlock::Knot> CoupledFlock::States() const {
  std::vector<Knot> states;
  for (const Bird& bird : birds_) {
    for (int k = 0; k < bird.knots; ++k) {
      const auto p = PointOf(&bird.path[3 * static_cast<std::size_t>(k)], 1 / model_.knot_interval,
                             CameraAt(bird, k));
      states.push_back({p.x, p.v, p.z * p.a_over_z, p.z});
    }
  }
  return states;
}

void CoupledFlock::FreezeNeighbours() {
  const std::vector<Knot> states = States();
  Vec3d sum;
  for (const Knot& s : states) sum += s.x;
  forces.center = (1 / static_cast<double>(std::max<std::size_t>(states.size(), 1))) * sum;
  cruising_speed_.clear();
  for (const Bird& bird : birds_) cruising_speed_.push_back(std::exp(bird.own[kOwnLogSpeed]));
  const double reach = forces.Reach() + kMargin;
  for (std::vector<int>& list : neighbours_) list.clear();
  for (std::size_t g = 0; g < present_.size(); ++g) {
    std::vector<std::size_t> order = present_[g];
    const auto line = [&](std::size_t i) {
      return first_line_[i] + g - static_cast<std::size_t>(birds_[i].first_knot);
    };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
      return states[line(i)].x.x < states[line(j)].x.x;
    });
    for (std::size_t a = 0; a < order.size(); ++a) {
      for (std::size_t b = a + 1; b < order.size(); ++b) {
        const Vec3d dx = states[line(order[b])].x - states[line(order[a])].x;
        if (dx.x > reach) break;
        if (Norm(dx) > reach) continue;
        neighbours_[line(order[a])].push_back(static_cast<int>(order[b]));
        neighbours_[line(order[b])].push_back(static_cast<int>(order[a]));
      }
    }
  }
  for (std::vector<int>& list : neighbours_) std::sort(list.begin(), list.end());
}

std::vector<Offset> CoupledFlock::OffsetsOf(std::size_t bird, int knot,
                                            const std::vector<Knot>& states) const {
  const std::size_t line = first_line_[bird] + static_cast<std::size_t>(knot);
  std::vector<Offset> offsets;
  for (const int j : neighbours_[line]) {
    const auto other = static_cast<std::size_t>(j);
    const std::size_t at =
        first_line_[other] +
        static_cast<std::size_t>(birds_[bird].first_knot + knot - birds_[other].first_knot);
    offsets.push_back({states[at].x - states[line].x, states[at].v - states[line].v});
  }
  return offsets;
}

Vec3d CoupledFlock::ErrorOf(std::size_t bird, int knot, const std::vector<Knot>& states) const {
  const Knot& s = states[first_line_[bird] + static_cast<std::size_t>(knot)];
  const double time = (birds_[bird].first_knot + knot) * model_.knot_interval;
  const Vec3d force = PairForce(forces, OffsetsOf(bird, knot, states), nullptr) +
                      SelfForce(forces, cruising_speed_[bird], time, s.x, s.v, nullptr);
  return (birds_[bird].reference_depth / s.z) * (s.a - force);
}

CameraMotion CoupledFlock::CameraAt(const Bird& bird, int knot) const {
  return model_.camera.At((bird.first_knot + knot) * model_.knot_interval);
}

double CoupledFlock::Whitening(int knot) const {
  const double rho = noise.Correlation(model_.knot_interval);
  return 1 / (knot == 0 ? noise.sd : noise.StepSd(rho));
}

double CoupledFlock::Cost() const {
  const std::vector<Knot> states = States();
  const double rho = noise.Correlation(model_.knot_interval);
  double cost = SharedPriors(model_, shared_, nullptr, nullptr);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    ForEachRow(model_, birds_[i], shared_, false, [&](Term term, const ResidualRow& row) {
      if (term != Term::kAcceleration) cost += RobustCost(term, row.residual);
    });
    Vec3d before;
    for (int k = 0; k < birds_[i].knots; ++k) {
      const Vec3d error = ErrorOf(i, k, states);
      const Vec3d row = Whitening(k) * (k == 0 ? error : error - rho * before);
      for (int axis = 0; axis < 3; ++axis) {
        cost += RobustCost(Term::kAcceleration, Component(row, axis));
      }
      before = error;
    }
  }
  return cost;
}

bool CoupledFlock::Minimize(int max_iterations, const std::function<void()>& on_iteration) {
  constexpr double kFirstDamping = 1e-3, kMostDamping = 1e6;
  constexpr double kEnoughRelative = 1e-4;  // fall of the cost that counts
  double damping = kFirstDamping;
  double cost = Cost();
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    if (on_iteration) on_iteration();
    Eigen::VectorXd step;
    if (!Step(damping, &step)) {
      damping *= 10;
      if (damping > kMostDamping) return false;
      continue;
    }
    const std::vector<Bird> birds = birds_;
    const Eigen::VectorXd shared = shared_;
    for (std::size_t i = 0; i < birds_.size(); ++i) {
      for (int a = 0; a < birds_[i].unknowns(); ++a) {
        birds_[i].path[static_cast<std::size_t>(a)] += step[offset_[i] + a];
      }
      for (int a = 0; a < kOwnUnknowns; ++a) {
        birds_[i].own[static_cast<std::size_t>(a)] += step[offset_[i] + birds_[i].unknowns() + a];
      }
    }
    shared_ += step.tail(model_.shared());
    const double candidate = Cost();
    if (candidate < cost) {
      const bool still = cost - candidate < kEnoughRelative * cost;
      cost = candidate;
      damping = std::max(0.1 * damping, 1e-7);
      if (still) return true;
    } else {
      birds_ = birds;
      shared_ = shared;
      damping *= 10;
      if (damping > kMostDamping) return true;
    }
  }
  return false;
}

double CoupledFlock::UnexplainedSd() const {
  const std::vector<Knot> states = States();
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    for (int k = 0; k < birds_[i].knots; ++k) {
      const Vec3d e = ErrorOf(i, k, states);
      sum += Dot(e, e);
      count += 3;
    }
  }
  return std::sqrt(sum / std::max(count, 1.0));
}

}  // namespace flocklift::internal
