// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/boids_motion.h"

#include <algorithm>
#include <type_traits>

#include "simulate/core/check.h"
#include "simulate/fields/curl_noise.h"
#include "simulate/flock/correlated_noise.h"
#include "simulate/flock/force_passes.h"
#include "simulate/flock/integrator.h"
#include "simulate/flock/pair_forces.h"
#include "simulate/flock/surroundings_forces.h"

namespace flocklift {
namespace {

template <typename T>
class BoidsMotion final : public Motion<T> {
 public:
  BoidsMotion(const BoidsParameters<double>& p, const MotionContext& context, const Herd<T>& herd)
      : p_(InSeconds(p)),
        kernel_(std::is_same_v<T, float> ? ChooseKernel(context.kernel) : nullptr),
        forces_(context, herd.size()),
        noise_(Stream::kNoise, herd.size()) {
    if (MayList()) lists_.Reserve(ListReach(), context.world->dt, kernel_, context.pool, herd.now);
  }

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    AddPairs(around.dt(), pool, herd);
    forces_.Add(around, pool, herd);
    pool->For(0, static_cast<std::int64_t>(herd->size()), kAgentGrain,
              [&](std::int64_t first, std::int64_t last) { Move(around, first, last, herd); });
  }
  void Retune(const ModelParameters& parameters) override {
    p_ = InSeconds(std::get<BoidsParameters<double>>(parameters));
  }
  void Save(StateWriter* out) const override {
    out->Put(noise_.state());
    lists_.Save(out);
    forces_.Save(out);
  }
  void Load(StateReader* in) override {
    in->Take(&noise_.state());
    lists_.Load(in);
    forces_.Load(in);
  }

 private:
  // Other terms may need the order of cells at every step; else lists are kept where they last.
  bool MayList() const { return p_.nearest == 0 && forces_.Reach() <= 0; }
  NearReach<T> ListReach() const { return {static_cast<T>(Reach(p_)), T(0)}; }

  void AddPairs(double dt, ThreadPool* pool, Herd<T>* herd) {
    const bool listed = MayList() && lists_.UpdateIfWorth(ListReach(), dt, kernel_, pool, herd);
    if (!listed) herd->SortBy(std::max(Reach(p_), forces_.Reach()), pool);
    NeighbourLists nearest;
    PairTask<T> task = TaskOf(herd);
    if (listed) task.lists = &lists_;
    if (p_.nearest > 0) {
      nearest = FindNearest(herd->now, static_cast<int>(p_.nearest), pool);
      task.nearest = &nearest;
    }
    SumPairs<T>(p_, kernel_, task, pool);
  }

  void Move(const Surroundings& around, std::int64_t first, std::int64_t last, Herd<T>* herd) {
    const T dt = static_cast<T>(around.dt());
    const SpeedLimit::Params<T> limit{static_cast<T>(p_.s_min), static_cast<T>(p_.s_max), T(0)};
    Bodies<T>& s = herd->now;
    const bool alone = p_.alpha_b == 0 && p_.cruise == 0 && p_.level == 0 && p_.noise == 0 &&
                       around.predators.empty() && !HasGoal(around, *herd);
    if constexpr (std::is_same_v<T, float>) {
      if (alone && !around.flat() && kernel_ != nullptr) {
        const MoveJob job{s.x.data(),      s.y.data(),  s.z.data(),      s.vx.data(),
                          s.vy.data(),     s.vz.data(), herd->ax.data(), herd->ay.data(),
                          herd->az.data(), dt,          limit.min,       limit.max};
        kernel_->move(job, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
        return;
      }
    }
    const Region& box = around.world->box;
    const Vec3<T> low = Cast<T>(box.low), high = Cast<T>(box.high);
    for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last); ++k) {
      Vec3<T> x = s.Position(k), v = s.Velocity(k);
      Vec3<T> a = herd->Acceleration(k);
      if (!alone) {
        const std::uint32_t agent = s.agent[k];
        a += MakeBoidsSelf(p_, low, high, herd->cruising_speed[agent]).At(x, v);
        a += GoalPull(around, *herd, static_cast<T>(p_.goal_range), x, v);
        a += Fear(around, x);
        a += Noise(around, herd->first_agent, agent, x);
      }
      Advance(Flattened(around.flat(), a), dt, limit, &x, &v);
      s.Set(k, x, v);
    }
  }

  Vec3<T> Noise(const Surroundings& around, std::uint64_t first_agent, std::uint32_t agent,
                const Vec3<T>& x) {
    const auto kind = static_cast<NoiseKind>(p_.noise_kind.index);
    if (p_.noise == 0 || kind == NoiseKind::kNone) return {};
    if (kind == NoiseKind::kWhite) {
      return noise_.Next(around, first_agent, agent, p_.noise, p_.noise_time);
    }
    // Of amplitude gain / scale = p.noise.
    const NoiseTerm<T> field{static_cast<T>(p_.noise * p_.noise_scale),
                             static_cast<T>(p_.noise_scale),
                             static_cast<std::uint32_t>(around.world->seed)};
    return kind == NoiseKind::kCurl ? CurlNoise(field, x) : PerlinVelocity(field, x);
  }

  BoidsParameters<double> p_;    // in seconds
  const KernelVariant* kernel_;  // null: scalar
  VerletLists<T> lists_{kListSkin};
  ForcePasses<T> forces_;
  CorrelatedNoise<T> noise_;
};

}  // namespace

template <typename T>
std::unique_ptr<Motion<T>> MakeBoidsMotion(const BoidsParameters<double>& parameters,
                                           const MotionContext& context, const Herd<T>& herd) {
  return std::make_unique<BoidsMotion<T>>(parameters, context, herd);
}

template std::unique_ptr<Motion<float>> MakeBoidsMotion(const BoidsParameters<double>&,
                                                        const MotionContext&, const Herd<float>&);
template std::unique_ptr<Motion<double>> MakeBoidsMotion(const BoidsParameters<double>&,
                                                         const MotionContext&, const Herd<double>&);

}  // namespace flocklift
