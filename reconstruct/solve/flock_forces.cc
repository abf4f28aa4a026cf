// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/flock_forces.h"

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "simulate/flock/boids.h"
#include "simulate/forces/attraction.h"

namespace flocklift::internal {
namespace {

using JetW = ceres::Jet<double, 3>;  // of a window's: squared distance, radius, taper
using JetR = ceres::Jet<double, 5>;  // of a rule's sum: value and weight; and of its gain
using JetS = ceres::Jet<double, 6 + 1 + kSelfUnknowns + 3>;  // (x, v), log speed, unknowns, target

BoidsPairs<double> PairsOf(const FlockForces& forces) {
  BoidsParameters<double> p;
  p.d_s = forces[kLogDs];
  p.d_v = forces[kLogDv];
  p.alpha_s = forces[kLogAlphaS];
  p.alpha_c = forces[kLogAlphaC];
  p.alpha_a = forces[kLogAlphaA];
  return MakeBoidsPairs<double>(p, forces[kLogTaper]);
}

template <typename Jet>
Vec3<Jet> Seeded(const Vec3d& v, int first) {
  return {Jet(v.x, first), Jet(v.y, first + 1), Jet(v.z, first + 2)};
}

// The sum of one rule over the neighbours, with what its window's radius and taper change.
struct RuleSum {
  Weighted<double> sum;
  Eigen::Matrix<double, 4, 2> by_edge = Eigen::Matrix<double, 4, 2>::Zero();  // (value, weight)
  Eigen::Matrix<double, 3, 5> force;  // derivatives by (value, weight) and the gain's logarithm

  void Add(const Vec3d& value, const Weight& weight) {
    sum += Share<double>{value, weight.value};
    if (weight.by_square == 0) return;
    const Eigen::Vector4d with{value.x, value.y, value.z, 1};
    by_edge.col(0) += weight.by_radius * with;
    by_edge.col(1) += weight.by_taper * with;
  }
  // The term's own last step.
  template <typename Term>
  void Finish(double gain) {
    const Weighted<JetR> jets{{JetR(sum.value.x, 0), JetR(sum.value.y, 1), JetR(sum.value.z, 2)},
                              JetR(sum.weight, 3)};
    typename Term::template Params<JetR> p{};
    p.gain = JetR(gain);
    p.gain.v[4] = gain;
    const Vec3<JetR> f = Term::Finish(p, jets);
    force << f.x.v.transpose(), f.y.v.transpose(), f.z.v.transpose();
  }
  // The force is a multiple of the mean value.
  double by_value() const { return force(0, 0); }
  // By a neighbour's weight, for what it adds itself.
  Eigen::Vector3d ByWeight(const Vec3d& value) const {
    return force.col(3) + by_value() * Eigen::Vector3d{value.x, value.y, value.z};
  }
  Eigen::Vector3d ByRadius() const { return force.leftCols<4>() * by_edge.col(0); }
  Eigen::Vector3d ByTaper() const { return force.leftCols<4>() * by_edge.col(1); }
};

struct RuleSums {
  RuleSum separation, cohesion, alignment;

  void Finish(const BoidsPairs<double>& rules) {
    separation.Finish<Separation>(rules.separation.gain);
    cohesion.Finish<Cohesion>(rules.cohesion.gain);
    alignment.Finish<Alignment>(rules.alignment.gain);
  }
  // After it: of a neighbour with these weights.
  ByOffset ByOne(const Offset& offset, const Weight& near, const Weight& seen) const {
    const auto& [dx, dv] = offset;
    ByOffset by{.x = separation.by_value() * near.value + cohesion.by_value() * seen.value,
                .v = alignment.by_value() * seen.value};
    if (near.by_square != 0) by.across += 2 * near.by_square * separation.ByWeight(dx);
    if (seen.by_square != 0) {
      by.across += 2 * seen.by_square * (cohesion.ByWeight(dx) + alignment.ByWeight(dv));
    }
    if (by.on_edge()) by.along = {dx.x, dx.y, dx.z};
    return by;
  }
};

template <typename T>
struct SelfParameters {
  T log_speed, cruise, drive, level, goal, range;
  Vec3<T> target;
};

template <typename T>
Vec3<T> SelfForceOf(const SelfParameters<T>& p, const std::optional<Vec3d>& up, const Vec3<T>& x,
                    const Vec3<T>& v) {
  using std::exp;
  Vec3<T> force = CruiseSpeed::At({p.cruise, p.drive * exp(p.log_speed)}, x, v);
  if (up) {
    const T climb = v.x * up->x + v.y * up->y + v.z * up->z;
    const T sink = Level::At({p.level}, x, Vec3<T>{T(0.0), T(0.0), climb}).z;
    force += Vec3<T>{sink * up->x, sink * up->y, sink * up->z};
  }
  force += Attraction::At({p.goal, p.target, p.range}, x, v);
  return force;
}

template <int Rows, typename Jet>
void CopyDerivatives(const Vec3<Jet>& force, int first,
                     Eigen::Ref<Eigen::Matrix<double, 3, Rows>> out) {
  out.row(0) = force.x.v.template segment<Rows>(first).transpose();
  out.row(1) = force.y.v.template segment<Rows>(first).transpose();
  out.row(2) = force.z.v.template segment<Rows>(first).transpose();
}

}  // namespace

FlockForces FlockForces::Usual(const Vec3d& center, double speed, double duration) {
  // The simulator's birds, at 10 m/s; and a goal that makes them circle within some 15 m.
  const BoidsParameters<double> birds;
  constexpr double kSpeed = 10, kTaper = 3, kDrive = 1.1, kGoal = 0.5, kRange = 20;
  const double larger = speed / kSpeed;
  const std::array<double, kForceScalars> usual = {
      larger * birds.d_s, larger * birds.d_v, larger * kTaper, birds.alpha_s, birds.alpha_c,
      birds.alpha_a,      birds.cruise,       kDrive,          birds.level,   kGoal,
      larger * kRange};
  FlockForces f;
  const int knots = 2 + static_cast<int>(duration / kTargetKnotTime);
  f.unknowns.resize(kForceScalars + 3 * knots);
  for (int k = 0; k < kForceScalars; ++k) {
    f.unknowns[k] = std::log(usual[static_cast<std::size_t>(k)]);
  }
  for (int k = 0; k < knots; ++k) {
    f.unknowns.segment<3>(kForceScalars + 3 * k) << center.x, center.y, center.z;
  }
  return f;
}

double FlockForces::operator[](ForceUnknown k) const { return std::exp(unknowns[k]); }

FlockForces::Share FlockForces::ShareAt(double time) const {
  const double place = std::clamp(time / kTargetKnotTime, 0.0, target_knots() - 1.0);
  const int knot = std::min(static_cast<int>(place), target_knots() - 2);
  return {knot, place - knot};
}

Vec3d FlockForces::TargetAt(double time) const {
  const Share share = ShareAt(time);
  const double* at = &unknowns[kForceScalars + 3 * share.knot];
  return (1 - share.next) * Vec3d{at[0], at[1], at[2]} + share.next * Vec3d{at[3], at[4], at[5]};
}

WeightWindow::WeightWindow(double radius, double taper)
    : radius_(radius),
      taper_(taper),
      inner_(std::pow(std::max(0.0, radius - 0.5 * taper), 2)),
      outer_(std::pow(radius + 0.5 * taper, 2)) {}

double WeightWindow::ValueAt(double square) const {
  if (square < inner_) return 1;
  return square > outer_ ? 0 : TaperWindow(square, radius_, taper_);
}

Weight WeightWindow::At(double square) const {
  if (square < inner_) return {.value = 1};
  if (square > outer_) return {};
  const JetW w = TaperWindow(JetW(square, 0), JetW(radius_, 1), JetW(taper_, 2));
  return {w.a, w.v[0], w.v[1], w.v[2]};
}

PairForce::PairForce(const FlockForces& forces)
    : rules_(PairsOf(forces)),
      near_(rules_.separation.radius, rules_.separation.taper),
      seen_(rules_.cohesion.radius, rules_.cohesion.taper) {}

Vec3d PairForce::operator()(std::span<const Offset> offsets, ByOffset* by_offsets,
                            PairUnknownsMatrix* by_unknowns) {
  if (by_unknowns == nullptr) {
    BoidsPairs<double>::Sums sums;
    for (const Offset& o : offsets) sums += SharesOf(o);
    return ForceOf(sums);
  }
  RuleSums rules;
  auto& [separation, cohesion, alignment] = rules;
  weights_.clear();
  for (const Offset& o : offsets) {
    const double square = Dot(o.dx, o.dx);
    const auto& [near, seen] =
        weights_.emplace_back(std::array{near_.At(square), seen_.At(square)});
    separation.Add(o.dx, near);
    cohesion.Add(o.dx, seen);
    alignment.Add(o.dv, seen);
  }
  rules.Finish(rules_);
  for (std::size_t j = 0; j < offsets.size(); ++j) {
    by_offsets[j] = rules.ByOne(offsets[j], weights_[j][0], weights_[j][1]);
  }
  by_unknowns->col(kLogDs) = rules_.separation.radius * separation.ByRadius();
  by_unknowns->col(kLogDv) = rules_.cohesion.radius * (cohesion.ByRadius() + alignment.ByRadius());
  by_unknowns->col(kLogTaper) =
      rules_.cohesion.taper * (separation.ByTaper() + cohesion.ByTaper() + alignment.ByTaper());
  by_unknowns->col(kLogAlphaS) = separation.force.col(4);
  by_unknowns->col(kLogAlphaC) = cohesion.force.col(4);
  by_unknowns->col(kLogAlphaA) = alignment.force.col(4);
  return rules_.Finish({separation.sum, cohesion.sum, alignment.sum});
}

BoidsPairs<double>::Shares PairForce::SharesOf(const Offset& offset) const {
  const double square = Dot(offset.dx, offset.dx), seen = seen_.ValueAt(square);
  return {{offset.dx, near_.ValueAt(square)}, {offset.dx, seen}, {offset.dv, seen}};
}

ByOffset PairForce::ByOne(const Sums& sums, const Offset& offset) const {
  RuleSums rules;
  rules.separation.sum = sums.separation;
  rules.cohesion.sum = sums.cohesion;
  rules.alignment.sum = sums.alignment;
  rules.Finish(rules_);
  const double square = Dot(offset.dx, offset.dx);
  return rules.ByOne(offset, near_.At(square), seen_.At(square));
}

Vec3d SelfForce(const FlockForces& forces, double log_speed, double time, const Vec3d& x,
                const Vec3d& v, SelfDerivatives* derivatives) {
  const Vec3d target = forces.TargetAt(time);
  if (derivatives == nullptr) {
    return SelfForceOf<double>({log_speed, forces[kLogCruise], forces[kLogDrive], forces[kLogLevel],
                                forces[kLogGoal], forces[kLogRange], target},
                               forces.up_in_cam, x, v);
  }
  constexpr int kOwn = 6, kFirst = kOwn + 1, kTarget = kFirst + kSelfUnknowns;
  const auto unknown = [&](ForceUnknown k) {
    using std::exp;
    return exp(JetS(forces.unknowns[k], kFirst + k - kPairUnknowns));
  };
  const Vec3<JetS> f = SelfForceOf<JetS>(
      {JetS(log_speed, kOwn), unknown(kLogCruise), unknown(kLogDrive), unknown(kLogLevel),
       unknown(kLogGoal), unknown(kLogRange), Seeded<JetS>(target, kTarget)},
      forces.up_in_cam, Seeded<JetS>(x, 0), Seeded<JetS>(v, 3));
  CopyDerivatives<6>(f, 0, derivatives->by_state);
  derivatives->by_log_speed << f.x.v[kOwn], f.y.v[kOwn], f.z.v[kOwn];
  CopyDerivatives<kSelfUnknowns>(f, kFirst, derivatives->by_unknowns);
  CopyDerivatives<3>(f, kTarget, derivatives->by_target);
  return {f.x.a, f.y.a, f.z.a};
}

}  // namespace flocklift::internal
