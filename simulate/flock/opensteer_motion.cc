// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/opensteer_motion.h"

#include <algorithm>
#include <type_traits>

#include "simulate/flock/correlated_noise.h"
#include "simulate/flock/force_passes.h"
#include "simulate/flock/integrator.h"
#include "simulate/flock/pair_forces.h"
#include "simulate/flock/surroundings_forces.h"
#include "simulate/forces/boundary.h"

namespace flocklift {
namespace {

template <typename T>
class OpenSteerMotion final : public Motion<T> {
 public:
  OpenSteerMotion(const OpenSteerParameters& p, const MotionContext& context, const Herd<T>& herd)
      : p_(p),
        kernel_(std::is_same_v<T, float> ? ChooseKernel(context.kernel) : nullptr),
        forces_(context, herd.size()),
        noise_(Stream::kNoise, herd.size()) {}

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    herd->SortBy(std::max(Reach(p_.rules), forces_.Reach()), pool);
    FindHeadings(pool, *herd);
    SumPairs<T>(p_.rules, kernel_,
                {herd->grid, headings_, herd->ax, herd->ay, herd->az, herd->neighbours}, pool);
    const SpeedLimit::Params<T> strength{T(0), F(p_.max_force), T(0)};
    ForEachAnimal(*herd, pool, [&](std::size_t k) {
      herd->SetAcceleration(
          k, SpeedLimit::Limit(strength, herd->Acceleration(k)) + FromWorld(around, *herd, k));
    });
    forces_.Add(around, pool, herd);
    const SpeedLimit::Params<T> limit{F(p_.s_min), F(p_.s_max), T(0)};
    ForEachAnimal(*herd, pool, [&](std::size_t k) {
      Vec3<T> x = herd->now.Position(k), v = herd->now.Velocity(k);
      Advance(Flattened(around.flat(), herd->Acceleration(k)), F(around.dt()), limit, &x, &v);
      herd->now.Set(k, x, v);
    });
  }
  void Retune(const ModelParameters& parameters) override {
    p_ = std::get<OpenSteerParameters>(parameters);
  }
  void Save(StateWriter* out) const override {
    out->Put(noise_.state());
    forces_.Save(out);
  }
  void Load(StateReader* in) override {
    in->Take(&noise_.state());
    forces_.Load(in);
  }

 private:
  static T F(double value) { return static_cast<T>(value); }

  // The herd with headings for velocities.
  void FindHeadings(ThreadPool* pool, const Herd<T>& herd) {
    headings_.Resize(herd.size());
    ForEachAnimal(herd, pool, [&](std::size_t k) {
      headings_.Set(k, herd.now.Position(k), SoftUnit(herd.now.Velocity(k)));
    });
  }

  Vec3<T> FromWorld(const Surroundings& around, const Herd<T>& herd, std::size_t k) {
    const Vec3<T> x = herd.now.Position(k), v = herd.now.Velocity(k);
    const Region& box = around.world->box;
    const Boundary::Params<T> walls{F(p_.alpha_b), Cast<T>(box.low), Cast<T>(box.high),
                                    F(p_.wall_taper)};
    Vec3<T> a = Boundary::At(walls, x, v) + GoalPull(around, herd, F(p_.goal_range), x, v) +
                Fear(around, x);
    if (p_.noise > 0) {
      a += noise_.Next(around, herd.first_agent, herd.now.agent[k], p_.noise, p_.noise_time);
    }
    return a;
  }

  OpenSteerParameters p_;
  const KernelVariant* kernel_;  // null: scalar
  ForcePasses<T> forces_;
  CorrelatedNoise<T> noise_;
  Bodies<T> headings_;
};

}  // namespace

template <typename T>
std::unique_ptr<Motion<T>> MakeOpenSteerMotion(const OpenSteerParameters& parameters,
                                               const MotionContext& context, const Herd<T>& herd) {
  return std::make_unique<OpenSteerMotion<T>>(parameters, context, herd);
}

template std::unique_ptr<Motion<float>> MakeOpenSteerMotion(const OpenSteerParameters&,
                                                            const MotionContext&,
                                                            const Herd<float>&);
template std::unique_ptr<Motion<double>> MakeOpenSteerMotion(const OpenSteerParameters&,
                                                             const MotionContext&,
                                                             const Herd<double>&);

}  // namespace flocklift
