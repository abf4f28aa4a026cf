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

using Jet4 = ceres::Jet<double, 4>;  // of a rule's sum: value and weight
using Jet3 = ceres::Jet<double, 3>;  // of dx
using JetE = ceres::Jet<double, 3>;  // of the edges: d_s, d_v, taper
using JetP = ceres::Jet<double, kPairUnknowns>;
using JetS = ceres::Jet<double, 6 + 1 + kSelfUnknowns + 3>;  // (x, v), log speed, unknowns, target

// The rules of neighbours with parameters given by `unknown`, of any scalar.
template <typename T, typename Unknown>
BoidsPairs<T> PairsOf(const Unknown& unknown) {
  BoidsParameters<T> p;
  p.d_s = unknown(kLogDs);
  p.d_v = unknown(kLogDv);
  p.alpha_s = unknown(kLogAlphaS);
  p.alpha_c = unknown(kLogAlphaC);
  p.alpha_a = unknown(kLogAlphaA);
  return MakeBoidsPairs<T>(p, unknown(kLogTaper));
}

template <typename Jet>
Vec3<Jet> Seeded(const Vec3d& v, int first) {
  return {Jet(v.x, first), Jet(v.y, first + 1), Jet(v.z, first + 2)};
}

// What a rule's sum is made of, with derivatives by each neighbour.
struct RuleSum {
  Weighted<double> sum;
  std::vector<Eigen::Matrix<double, 4, 3>> by;  // of (value, weight) by each neighbour's dx
  std::vector<double> by_dv;                    // of value by its dv, times the unit matrix

  // `velocities`: do these average dv, rather than something of dx?
  void Add(const Share<Jet3>& share, bool velocities) {
    const Vec3<Jet3> value = share.weight * share.value;
    sum.value += Vec3d{value.x.a, value.y.a, value.z.a};
    sum.weight += share.weight.a;
    Eigen::Matrix<double, 4, 3>& d = by.emplace_back();
    d.row(0) = value.x.v.transpose();
    d.row(1) = value.y.v.transpose();
    d.row(2) = value.z.v.transpose();
    d.row(3) = share.weight.v.transpose();
    if (velocities) by_dv.push_back(share.weight.a);
  }
  Weighted<Jet4> AsJets() const {
    Weighted<Jet4> jets;
    jets.value = {Jet4(sum.value.x, 0), Jet4(sum.value.y, 1), Jet4(sum.value.z, 2)};
    jets.weight = Jet4(sum.weight, 3);
    return jets;
  }
  // Adds the rule's derivatives.
  void Finish(const Vec3<Jet4>& force, ByOffset* derivatives) const {
    Eigen::Matrix<double, 3, 4> by_sum;
    by_sum.row(0) = force.x.v.transpose();
    by_sum.row(1) = force.y.v.transpose();
    by_sum.row(2) = force.z.v.transpose();
    for (std::size_t j = 0; j < by.size(); ++j) derivatives[j].x.noalias() += by_sum * by[j];
    // The force is a multiple of the mean value.
    for (std::size_t j = 0; j < by_dv.size(); ++j) derivatives[j].v += by_sum(0, 0) * by_dv[j];
  }
};

// The same sum, with derivatives by all unknowns of neighbours' forces.
Weighted<JetP> AllUnknowns(const Weighted<JetE>& sum) {
  const auto wide = [](const JetE& x) {
    JetP jet(x.a);
    jet.v.head<3>() = x.v;
    return jet;
  };
  Weighted<JetP> all;
  all.value = {wide(sum.value.x), wide(sum.value.y), wide(sum.value.z)};
  all.weight = wide(sum.weight);
  return all;
}

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

Vec3d PairForce(const FlockForces& forces, std::span<const Offset> offsets, ByOffset* by_offsets,
                PairUnknownsMatrix* by_unknowns) {
  const auto value = [&forces](ForceUnknown k) { return forces[k]; };
  const auto plain = PairsOf<double>(value);
  BoidsPairs<double>::Sums sums;
  for (const Offset& o : offsets) sums += plain.Pair(o.dx, o.dv);
  if (by_offsets != nullptr) {
    const auto pairs = PairsOf<Jet3>([&](ForceUnknown k) { return Jet3(forces[k]); });
    RuleSum separation, cohesion, alignment;
    for (RuleSum* rule : {&separation, &cohesion, &alignment}) rule->by.reserve(offsets.size());
    for (std::size_t j = 0; j < offsets.size(); ++j) {
      const Vec3d& dv = offsets[j].dv;
      const auto shares =
          pairs.Pair(Seeded<Jet3>(offsets[j].dx, 0), {Jet3(dv.x), Jet3(dv.y), Jet3(dv.z)});
      separation.Add(shares.separation, false);
      cohesion.Add(shares.cohesion, false);
      alignment.Add(shares.alignment, true);
      by_offsets[j] = {};
    }
    const auto rules = PairsOf<Jet4>([&](ForceUnknown k) { return Jet4(forces[k]); });
    separation.Finish(Separation::Finish(rules.separation, separation.AsJets()), by_offsets);
    cohesion.Finish(Cohesion::Finish(rules.cohesion, cohesion.AsJets()), by_offsets);
    alignment.Finish(Alignment::Finish(rules.alignment, alignment.AsJets()), by_offsets);
  }
  if (by_unknowns != nullptr) {
    const auto unknown = [&forces](ForceUnknown k) {
      using std::exp;
      return exp(JetP(forces.unknowns[k], k));
    };
    // Sums depend on the edges alone; gains come last.
    const auto pairs = PairsOf<JetE>([&](ForceUnknown k) {
      JetE edge(forces[k]);
      if (k <= kLogTaper) edge.v[k] = edge.a;
      return edge;
    });
    BoidsPairs<JetE>::Sums total;
    const auto constant = [](const Vec3d& v) {
      return Vec3<JetE>{JetE(v.x), JetE(v.y), JetE(v.z)};
    };
    for (const Offset& o : offsets) total += pairs.Pair(constant(o.dx), constant(o.dv));
    const BoidsPairs<JetP>::Sums by_all{AllUnknowns(total.separation), AllUnknowns(total.cohesion),
                                        AllUnknowns(total.alignment)};
    CopyDerivatives<kPairUnknowns>(PairsOf<JetP>(unknown).Finish(by_all), 0, *by_unknowns);
  }
  return plain.Finish(sums);
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
