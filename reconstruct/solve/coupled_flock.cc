// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/coupled_flock.h"

#include <ceres/jet.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reconstruct/cost_functions/path.h"

namespace flocklift::internal {
namespace {

constexpr double kMargin = 2;  // beyond reach, so that a frozen neighbourhood stays whole [m]
using Jet9 = ceres::Jet<double, 9>;
using Vector3 = Eigen::Vector3d;

Vector3 AsEigen(const Vec3d& v) { return {v.x, v.y, v.z}; }

double Component(const Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

template <typename T>
struct PathPoint {
  Vec3<T> x, v, a_over_z;
  T z;
};

template <typename T>
PathPoint<T> PointOf(const T* path, double rate, const CameraMotion& camera) {
  using std::exp;
  const PathState<T> q = StateAtKnot(path, rate);
  const T z = exp(q.l);
  const Vec3<T> w = VelocityOverDepth(q, camera);
  const Vec3d& place = camera.place;
  return {{z * q.x + place.x, z * q.y + place.y, z + place.z},
          {z * w.x, z * w.y, z * w.z},
          AccelerationOverDepth(q, camera),
          z};
}

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

Eigen::VectorXd CoupledFlock::Apply(const Eigen::VectorXd& x, double damping) const {
  const Eigen::Index size = model_.shared();
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  Eigen::MatrixXd priors = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd unused = Eigen::VectorXd::Zero(size);
  SharedPriors(model_, shared_, &priors, &unused);
  Eigen::VectorXd of_shared = priors * x.tail(size);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Eigen::Index own = offset_[i + 1] - offset_[i];
    Eigen::VectorXd product = Eigen::VectorXd::Zero(own);
    const Eigen::VectorXd own_x = x.segment(offset_[i], own);
    batch_[i].AddProduct(own_x, x.tail(size), &product, &of_shared);
    for (Eigen::Index a = 0; a < own; ++a) {
      const bool is_depth = a < birds_[i].unknowns() && a % 3 == 2;
      product[a] +=
          damping * own_x[a] *
          (is_depth ? ArrowSystem::kDepthMetric : blocks_[i].Diagonal(static_cast<int>(a)));
    }
    y.segment(offset_[i], own) = product;
  }
  y.tail(size) = of_shared;
  AddDynamics(&x, &y);
  return y;
}

Eigen::VectorXd CoupledFlock::Precondition(const Eigen::MatrixXd& shared_matrix,
                                           const Eigen::VectorXd& x) {
  const Eigen::Index size = model_.shared();
  Eigen::VectorXd of_shared = x.tail(size);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    of_shared += blocks_[i].ReduceGradient(x.segment(offset_[i], offset_[i + 1] - offset_[i]));
  }
  const Eigen::VectorXd shared_step = -shared_matrix.llt().solve(of_shared);
  Eigen::VectorXd y(x.size());
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    y.segment(offset_[i], offset_[i + 1] - offset_[i]) = -blocks_[i].BackSubstitute(shared_step);
  }
  y.tail(size) = -shared_step;
  return y;
}

// Conjugate gradients until the residual, in the metric of the blocks, is a twentieth. False when a
// block is singular.
bool CoupledFlock::Step(double damping, Eigen::VectorXd* step) {
  constexpr int kMostRounds = 40;
  constexpr double kTolerance = 0.05;
  const Eigen::VectorXd gradient = Gradient();
  const Eigen::Index size = model_.shared();
  Eigen::MatrixXd shared_matrix = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd shared_gradient = Eigen::VectorXd::Zero(size);
  SharedPriors(model_, shared_, &shared_matrix, &shared_gradient);
  for (ArrowSystem& block : blocks_) {
    if (!block.Reduce(damping, &shared_matrix, &shared_gradient)) return false;
  }
  *step = Eigen::VectorXd::Zero(gradient.size());
  Eigen::VectorXd residual = -gradient;
  Eigen::VectorXd z = Precondition(shared_matrix, residual);
  Eigen::VectorXd direction = z;
  double rz = residual.dot(z);
  const double first = rz;
  for (int round = 0; round < kMostRounds && rz > kTolerance * kTolerance * first; ++round) {
    const Eigen::VectorXd product = Apply(direction, damping);
    const double curvature = direction.dot(product);
    if (!(curvature > 0) || !std::isfinite(curvature)) break;
    const double length = rz / curvature;
    *step += length * direction;
    residual -= length * product;
    z = Precondition(shared_matrix, residual);
    const double next = residual.dot(z);
    direction = z + (next / rz) * direction;
    rz = next;
  }
  return step->allFinite();
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
