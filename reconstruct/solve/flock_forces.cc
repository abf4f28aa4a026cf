// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/flock_forces.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "simulate/flock/boids.h"

namespace flocklift::internal {
namespace {

using Jet4 = ceres::Jet<double, 4>;  // of a rule's sum: value and weight
using Jet6 = ceres::Jet<double, 6>;  // of (dx, dv), or (x, v)

BoidsParameters<double> ParametersOf(const FlockForces& f) {
  BoidsParameters<double> p;
  p.d_s = f.d_s;
  p.d_v = f.d_v;
  p.alpha_s = f.alpha_s;
  p.alpha_c = f.alpha_c;
  p.alpha_a = f.alpha_a;
  return p;
}

template <typename T>
T Constant(double value) {
  return T(value);
}

Vec3<Jet6> Seeded(const Vec3d& v, int first) {
  return {Jet6(v.x, first), Jet6(v.y, first + 1), Jet6(v.z, first + 2)};
}

// What a rule's sum is made of, with derivatives by each neighbour.
struct RuleSum {
  Weighted<double> sum;
  std::vector<Eigen::Matrix<double, 4, 6>> by;  // of (value, weight), one for each neighbour

  void Add(const Share<Jet6>& share) {
    const Vec3<Jet6> value = share.weight * share.value;
    sum.value += Vec3d{value.x.a, value.y.a, value.z.a};
    sum.weight += share.weight.a;
    Eigen::Matrix<double, 4, 6>& d = by.emplace_back();
    d.row(0) = value.x.v.transpose();
    d.row(1) = value.y.v.transpose();
    d.row(2) = value.z.v.transpose();
    d.row(3) = share.weight.v.transpose();
  }
  Weighted<Jet4> AsJets() const {
    Weighted<Jet4> jets;
    jets.value = {Jet4(sum.value.x, 0), Jet4(sum.value.y, 1), Jet4(sum.value.z, 2)};
    jets.weight = Jet4(sum.weight, 3);
    return jets;
  }
  // Adds the rule's force and its derivatives.
  void Finish(const Vec3<Jet4>& force, Vec3d* total, Matrix36* derivatives) const {
    *total += Vec3d{force.x.a, force.y.a, force.z.a};
    Eigen::Matrix<double, 3, 4> by_sum;
    by_sum.row(0) = force.x.v.transpose();
    by_sum.row(1) = force.y.v.transpose();
    by_sum.row(2) = force.z.v.transpose();
    for (std::size_t j = 0; j < by.size(); ++j) derivatives[j].noalias() += by_sum * by[j];
  }
};

template <typename T>
Vec3<T> SelfForceOf(const FlockForces& f, double cruising_speed, const Vec3d& pull,
                    const Vec3<T>& x, const Vec3<T>& v) {
  Vec3<T> force = CruiseSpeed::At({Constant<T>(f.cruise), Constant<T>(cruising_speed)}, x, v);
  if (f.up_in_cam) {
    const Vec3d& up = *f.up_in_cam;
    const T climb = v.x * up.x + v.y * up.y + v.z * up.z;
    const T sink = Level::At({Constant<T>(f.level)}, x, Vec3<T>{T(0.0), T(0.0), climb}).z;
    force += Vec3<T>{sink * up.x, sink * up.y, sink * up.z};
  }
  force += Vec3<T>{f.spring * (f.center.x - x.x) + pull.x, f.spring * (f.center.y - x.y) + pull.y,
                   f.spring * (f.center.z - x.z) + pull.z};
  return force;
}

}  // namespace

Vec3d FlockForces::PullAt(double time) const {
  if (pull.empty()) return {};
  const double place = std::clamp(time / kPullKnotTime, 0.0, static_cast<double>(pull.size()) - 1);
  const std::size_t left = std::min(static_cast<std::size_t>(place), pull.size() - 1);
  const std::size_t right = std::min(left + 1, pull.size() - 1);
  const double share = place - static_cast<double>(left);
  return (1 - share) * pull[left] + share * pull[right];
}

Vec3d PairForce(const FlockForces& forces, std::span<const Offset> offsets, Matrix36* derivatives) {
  if (derivatives == nullptr) {
    const auto pairs = MakeBoidsPairs<double>(ParametersOf(forces), forces.Taper());
    BoidsPairs<double>::Sums sums;
    for (const Offset& o : offsets) sums += pairs.Pair(o.dx, o.dv);
    return pairs.Finish(sums);
  }
  const auto pairs = MakeBoidsPairs<Jet6>(ParametersOf(forces), Jet6(forces.Taper()));
  RuleSum separation, cohesion, alignment;
  for (std::size_t j = 0; j < offsets.size(); ++j) {
    const auto shares = pairs.Pair(Seeded(offsets[j].dx, 0), Seeded(offsets[j].dv, 3));
    separation.Add(shares.separation);
    cohesion.Add(shares.cohesion);
    alignment.Add(shares.alignment);
    derivatives[j].setZero();
  }
  const auto rules = MakeBoidsPairs<Jet4>(ParametersOf(forces), Jet4(forces.Taper()));
  Vec3d total;
  separation.Finish(Separation::Finish(rules.separation, separation.AsJets()), &total, derivatives);
  cohesion.Finish(Cohesion::Finish(rules.cohesion, cohesion.AsJets()), &total, derivatives);
  alignment.Finish(Alignment::Finish(rules.alignment, alignment.AsJets()), &total, derivatives);
  return total;
}

Vec3d SelfForce(const FlockForces& forces, double cruising_speed, double time, const Vec3d& x,
                const Vec3d& v, Matrix36* derivative) {
  const Vec3d pull = forces.PullAt(time);
  if (derivative == nullptr) return SelfForceOf(forces, cruising_speed, pull, x, v);
  const Vec3<Jet6> f = SelfForceOf(forces, cruising_speed, pull, Seeded(x, 0), Seeded(v, 3));
  derivative->row(0) = f.x.v.transpose();
  derivative->row(1) = f.y.v.transpose();
  derivative->row(2) = f.z.v.transpose();
  return {f.x.a, f.y.a, f.z.a};
}

std::array<Vec3d, kForceGains> UnitForces(const FlockForces& forces, double cruising_speed,
                                          std::span<const Offset> offsets, const Vec3d& x,
                                          const Vec3d& v) {
  FlockForces unit = forces;
  unit.alpha_s = unit.alpha_c = unit.alpha_a = 1;
  const auto pairs = MakeBoidsPairs<double>(ParametersOf(unit), unit.Taper());
  BoidsPairs<double>::Sums sums;
  for (const Offset& o : offsets) sums += pairs.Pair(o.dx, o.dv);
  std::array<Vec3d, kForceGains> result;
  result[0] = Separation::Finish(pairs.separation, sums.separation);
  result[1] = Cohesion::Finish(pairs.cohesion, sums.cohesion);
  result[2] = Alignment::Finish(pairs.alignment, sums.alignment);
  for (int rule = 0; rule < 3; ++rule) {
    FlockForces alone;
    alone.center = forces.center;
    alone.up_in_cam = forces.up_in_cam;
    (rule == 0 ? alone.cruise : rule == 1 ? alone.level : alone.spring) = 1;
    result[static_cast<std::size_t>(3 + rule)] = SelfForceOf(alone, cruising_speed, {}, x, v);
  }
  return result;
}

}  // namespace flocklift::internal
