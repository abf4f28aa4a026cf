// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/coupled_flock.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "reconstruct/solve/coupled_point.h"
#include "reconstruct/solve/curves.h"

namespace flocklift::internal {
namespace {

constexpr double kMargin = 2;  // beyond reach, so that a frozen neighbourhood stays whole [m]
constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-7, kMostDamping = 1e6;

double MeanLogDepth(const Bird& bird) {
  double sum = 0;
  for (std::size_t k = 2; k < bird.path.size(); k += 3) sum += bird.path[k];
  return sum * 3 / static_cast<double>(bird.path.size());
}

double MeanLogDepth(const std::vector<Bird>& birds) {
  double sum = 0;
  for (const Bird& bird : birds) sum += MeanLogDepth(bird);
  return birds.empty() ? 0 : sum / static_cast<double>(birds.size());
}

}  // namespace

CoupledFlock::CoupledFlock(const BatchModel& model, std::vector<Bird>* birds,
                           Eigen::VectorXd* shared, const std::optional<Scale>& scale)
    : model_(model),
      birds_(*birds),
      shared_(*shared),
      scale_(scale.value_or(Scale{MeanLogDepth(*birds), (*shared)[kFlockLogSpeed]})) {
  std::size_t lines = 0;
  Eigen::Index unknowns = 0;
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Bird& bird = birds_[i];
    first_of_bird_.push_back(lines);
    lines += static_cast<std::size_t>(bird.knots);
    place_.push_back(unknowns);
    unknowns += bird.unknowns() + kOwnUnknowns;
    const std::size_t first = static_cast<std::size_t>(bird.first_knot);
    const std::size_t end = first + static_cast<std::size_t>(bird.knots);
    if (present_.size() < end) present_.resize(end);
    for (std::size_t time = first; time < end; ++time) present_[time].push_back(i);
  }
  place_.push_back(unknowns);
  lines_.resize(lines);
  line_of_.resize(lines);
  ForEachLine([this](std::size_t i, int k, std::size_t line) {
    line_of_[first_of_bird_[i] + static_cast<std::size_t>(k)] = line;
  });
  Vec3d sum;
  for (const Knot& s : States()) sum += s.x;
  forces = FlockForces::Usual((1 / static_cast<double>(std::max<std::size_t>(lines, 1))) * sum,
                              std::exp(scale_.log_speed),
                              static_cast<double>(present_.size()) * model_.knot_interval);
  forces.up_in_cam = model_.up_in_cam;
  usual_ = forces.unknowns;
  for (const Bird& bird : birds_) animals_.emplace_back(bird.unknowns(), kOwnUnknowns, border());
  Relinearize();
}

std::vector<CoupledFlock::Knot> CoupledFlock::States() const {
  std::vector<Knot> states;
  states.reserve(lines_.size());
  ForEachLine([&](std::size_t i, int k, std::size_t) {
    const auto p = PointOf(&birds_[i].path[3 * static_cast<std::size_t>(k)],
                           1 / model_.knot_interval, CameraAt(birds_[i], k));
    states.push_back({p.x, p.v, p.z * p.a_over_z, p.z});
  });
  return states;
}

void CoupledFlock::Relinearize() {
  const double grown = MeanLogDepth(birds_) - scale_.log_depth;
  for (Bird& bird : birds_) bird.reference_depth = std::exp(MeanLogDepth(bird) - grown);
  UpdateCurves(model_, &birds_);
  const std::vector<Knot> states = States();
  const double reach = forces.Reach() + kMargin;
  may_hear_.assign(lines_.size(), {});
  std::uint32_t line = 0;
  for (const std::vector<std::size_t>& present : present_) {
    std::vector<std::uint32_t> order(present.size());
    for (std::uint32_t& next : order) next = line++;
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return states[a].x.x < states[b].x.x;
    });
    for (std::size_t a = 0; a < order.size(); ++a) {
      for (std::size_t b = a + 1; b < order.size(); ++b) {
        const Vec3d dx = states[order[b]].x - states[order[a]].x;
        if (dx.x > reach) break;
        if (Norm(dx) > reach) continue;
        may_hear_[order[a]].push_back(order[b]);
        may_hear_[order[b]].push_back(order[a]);
      }
    }
  }
  for (std::vector<std::uint32_t>& list : may_hear_) std::sort(list.begin(), list.end());
}

void CoupledFlock::Hear(std::size_t line, double reach, const std::vector<Knot>& states,
                        Heard* heard) const {
  heard->offsets.clear();
  heard->lines.clear();
  const Knot& own = states[line];
  for (const std::uint32_t other : may_hear_[line]) {
    const Vec3d dx = states[other].x - own.x;
    if (Dot(dx, dx) > reach * reach) continue;
    heard->offsets.push_back({dx, states[other].v - own.v});
    heard->lines.push_back(other);
  }
}

CameraMotion CoupledFlock::CameraAt(const Bird& bird, int knot) const {
  return model_.camera.At((bird.first_knot + knot) * model_.knot_interval);
}

double CoupledFlock::Cost() const {
  const std::vector<Knot> states = States();
  const MarkovWhitening whitening = Whitening();
  const double reach = forces.Reach();
  PairForce pairs(forces);
  Heard heard;
  double cost = SharedPriors(model_, shared_, nullptr, nullptr) + ForcePriors(nullptr, nullptr);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    cost += CostOf(model_, birds_[i], shared_, RowKind::kNoAccelerations);
    Vec3d before;
    for (int k = 0; k < birds_[i].knots; ++k) {
      const std::size_t line = LineOf(i, k);
      const Knot& s = states[line];
      const double time = (birds_[i].first_knot + k) * model_.knot_interval;
      Hear(line, reach, states, &heard);
      const Vec3d force = pairs(heard.offsets, nullptr, nullptr) +
                          SelfForce(forces, birds_[i].own[kOwnLogSpeed], time, s.x, s.v, nullptr);
      const Vec3d error = (birds_[i].reference_depth / s.z) * (s.a - force);
      const Vec3d row = whitening.At(k) * (k == 0 ? error : error - whitening.rho * before);
      for (int axis = 0; axis < 3; ++axis) {
        cost += RobustCost(Term::kAcceleration, Component(row, axis));
      }
      before = error;
    }
  }
  return cost;
}

double CoupledFlock::ForcePriors(Eigen::MatrixXd* matrix, Eigen::VectorXd* gradient) const {
  // Of logarithms, in the order of ForceUnknown.
  constexpr std::array<double, kForceScalars> kSd = {0.25, 0.3, 0.4, 0.7, 1,  0.7,
                                                     0.7,  0.1, 0.7, 1,   0.7};
  // Of the target and its steps, in seconds of flight.
  constexpr double kTargetSd = 1, kTargetStepSd = 0.05;
  constexpr double kHeld = 1e-3, kHeldSeparation = 0.02;
  const double flight = std::exp(scale_.log_speed);
  double cost = 0;
  // (x_i - x_j - usual) / sd, without x_j where j < 0; places in the border.
  const auto add = [&](int i, int j, double off, double sd) {
    const double r = off / sd, w = 1 / (sd * sd);
    cost += 0.5 * r * r;
    if (matrix == nullptr) return;
    (*matrix)(i, i) += w;
    (*gradient)[i] += r / sd;
    if (j < 0) return;
    (*matrix)(j, j) += w;
    (*matrix)(i, j) -= w;
    (*matrix)(j, i) -= w;
    (*gradient)[j] -= r / sd;
  };
  Eigen::VectorXd off = forces.unknowns - usual_;
  off[kLogAlphaS] -= std::log(separation_);
  const int first = model_.shared();
  add(kFlockLogSpeed, -1, shared_[kFlockLogSpeed] - scale_.log_speed, kHeld);
  for (int k = 0; k < kForceScalars; ++k) {
    const bool told = k != kLogDrive && k != kLogGoal && k != kLogRange;  // by what birds are
    double sd = (told ? tightness : 1) * kSd[static_cast<std::size_t>(k)];
    if (k == kLogAlphaS && separation_ < 1) sd = kHeldSeparation;
    if (IsLength(k)) {
      add(first + k, kFlockLogSpeed, off[k] - (shared_[kFlockLogSpeed] - scale_.log_speed), sd);
    } else {
      add(first + k, -1, off[k], sd);
    }
  }
  for (int k = kForceScalars; k < forces.size(); ++k) {
    if (k < kForceScalars + 3) {
      add(first + k, -1, off[k], kTargetSd * flight);
    } else {
      add(first + k, first + k - 3, off[k] - off[k - 3], kTargetStepSd * flight);
    }
  }
  return cost;
}

void CoupledFlock::Move(const Eigen::VectorXd& step) {
  Eigen::Index at = 0;
  for (Bird& bird : birds_) {
    for (double& x : bird.path) x += step[at++];
    for (double& x : bird.own) x += step[at++];
  }
  shared_ += step.segment(at, model_.shared());
  forces.unknowns += step.tail(forces.size());
}

void CoupledFlock::HoldSeparation(double share) {
  separation_ = share;
  forces.unknowns[kLogAlphaS] = usual_[kLogAlphaS] + std::log(share);
}

void CoupledFlock::FitForces(int max_iterations) {
  double damping = kFirstDamping, cost = Cost();
  for (int iteration = 0; iteration < max_iterations && damping < kMostDamping; ++iteration) {
    model_.CountIteration();
    Linearize();
    const int n = forces.size();
    Eigen::MatrixXd matrix = priors_.bottomRightCorner(n, n);
    for (const ArrowSystem& animal : animals_) matrix += animal.corner().bottomRightCorner(n, n);
    matrix.diagonal() *= 1 + damping;
    const Eigen::VectorXd before = forces.unknowns;
    forces.unknowns -= matrix.llt().solve(gradient_.tail(n));
    const double candidate = Cost();
    if (candidate < cost) {
      const bool still = cost - candidate < Effort{}.enough * static_cast<double>(birds_.size());
      cost = candidate;
      damping = std::max(0.1 * damping, kLeastDamping);
      if (still) return;
    } else {
      forces.unknowns = before;
      damping *= 10;
    }
  }
}

bool CoupledFlock::Minimize(int max_iterations, const Effort& effort) {
  double damping = kFirstDamping, cost = Cost();
  bool linearized = false;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    if (damping > kMostDamping) return true;
    model_.CountIteration();
    if (!linearized) Linearize();
    linearized = true;
    if (!Factorise(damping)) {
      damping *= 10;
      continue;
    }
    const std::vector<Bird> birds = birds_;
    const Eigen::VectorXd shared = shared_, unknowns = forces.unknowns;
    const Eigen::VectorXd step = Solve<1>(-gradient_, effort.step);
    Move(step);
    const double candidate = Cost(), promised = -0.5 * gradient_.dot(step);
    if (candidate < cost) {
      const double fall = cost - candidate;
      cost = candidate;
      // Less where the step kept what the damped model promised of it (Nielsen, "Damping parameter
      // in Marquardt's method", 1999).
      const double kept = 2 * fall / promised - 1;
      damping = std::max(std::max(0.1, 1 - kept * kept * kept) * damping, kLeastDamping);
      linearized = false;
      if (fall < effort.enough * static_cast<double>(birds_.size())) return true;
      if (cost - (max_iterations - iteration - 1) * fall > effort.hopeless) return false;
    } else {
      birds_ = birds;
      shared_ = shared;
      forces.unknowns = unknowns;
      damping *= 10;
    }
  }
  return false;
}

const Eigen::VectorXd& CoupledFlock::Gradient() {
  Linearize();
  return gradient_;
}

}  // namespace flocklift::internal
