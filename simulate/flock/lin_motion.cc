// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/lin_motion.h"

#include <algorithm>
#include <cmath>

#include "simulate/flock/force_passes.h"
#include "simulate/flock/surroundings_forces.h"
#include "simulate/forces/lin.h"
#include "simulate/forces/speed.h"

namespace flocklift {
namespace {

template <typename T>
class LinMotion final : public Motion<T> {
 public:
  explicit LinMotion(const LinParameters<double>& p) : p_(p) {}

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    herd->SortBy(p_.d_sep, pool);
    FindTargets(pool, herd);
    const double kept = p_.inertia > 0 ? std::pow(p_.inertia, around.dt() / p_.frame_time) : 0;
    const SpeedLimit::Params<T> limit{T(0), static_cast<T>(p_.s_max), T(0)};
    for (std::size_t k = 0; k < herd->size(); ++k) {
      const Vec3<T> x = herd->now.Position(k);
      Vec3d wanted = p_.gain / p_.frame_time * ToDouble(herd->Acceleration(k));
      ForEachGoal(around, *herd, [&](const GoalSpec& goal) {
        wanted += p_.home * goal.weight * (goal.position - ToDouble(x));
      });
      const Vec3<T> v = SpeedLimit::Limit(
          limit, Flattened(around.flat(), static_cast<T>(kept) * herd->now.Velocity(k) +
                                              Cast<T>((1 - kept) * wanted)));
      herd->now.Set(k, x + static_cast<T>(around.dt()) * v, v);
    }
    for (std::vector<T>* column : {&herd->ax, &herd->ay, &herd->az}) {
      std::fill(column->begin(), column->end(), T(0));  // they were no accelerations
    }
  }
  void Retune(const ModelParameters& parameters) override {
    p_ = std::get<LinParameters<double>>(parameters);
  }

 private:
  // Leaves the ways to the targets in the herd's accelerations.
  void FindTargets(ThreadPool* pool, Herd<T>* herd) const {
    const Bodies<T>& s = herd->now;
    const Vec3d sum = SumOfPositions(s);
    const LinSeparation::Params<T> q{static_cast<T>(p_.d_sep), static_cast<T>(p_.exponent), T(0)};
    ForEachWithNeighbours(*herd, pool, [&](std::uint32_t k, const auto& for_neighbours) {
      Weighted<T> separation;
      for_neighbours([&](std::uint32_t j) {
        separation += LinSeparation::Pair(q, s.Position(j) - s.Position(k), Vec3<T>{});
      });
      herd->neighbours[k] = separation.weight;
      herd->SetAcceleration(k, WayToTarget(q, separation, sum, s, k));
    });
  }

  // Cohesion over all others from the sum of all: sum_i (x_i - x_n) = sum_i x_i - N x_n.
  Vec3<T> WayToTarget(const LinSeparation::Params<T>& q, const Weighted<T>& separation,
                      const Vec3d& sum, const Bodies<T>& s, std::size_t k) const {
    const auto n = static_cast<double>(s.size());
    const Vec3d x = ToDouble(s.Position(k));
    const Weighted<T> cohesion{Cast<T>(sum - n * x), static_cast<T>(n - 1)};
    return LinTarget(Vec3<T>{}, static_cast<T>(p_.w_sep), LinSeparation::Finish(q, separation),
                     LinCohesion::Finish(LinCohesion::Params<T>{}, cohesion));
  }

  LinParameters<double> p_;
};

}  // namespace

template <typename T>
std::unique_ptr<Motion<T>> MakeLinMotion(const LinParameters<double>& parameters,
                                         const MotionContext& context) {
  RefuseForces(context, "lin", "it moves positions");
  return std::make_unique<LinMotion<T>>(parameters);
}

template std::unique_ptr<Motion<float>> MakeLinMotion(const LinParameters<double>&,
                                                      const MotionContext&);
template std::unique_ptr<Motion<double>> MakeLinMotion(const LinParameters<double>&,
                                                       const MotionContext&);

}  // namespace flocklift
