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
#include "simulate/flock/kernels/boids_kernel.h"
#include "simulate/flock/surroundings_forces.h"

namespace flocklift {
namespace {

// The kernel's work, one pair at a time.
template <typename T>
void BoidsPairsScalar(const BoidsParameters<double>& p, std::int64_t first_row,
                      std::int64_t last_row, Herd<T>* herd) {
  const auto run = [&](const auto& pairs) {
    using Pairs = std::remove_cvref_t<decltype(pairs)>;
    const Bodies<T>& s = herd->now;
    ForEachInRows(*herd, first_row, last_row, [&](std::uint32_t k, const auto& for_neighbours) {
      typename Pairs::Sums sums;
      for_neighbours([&](std::uint32_t j) {
        sums += pairs.Pair(s.Position(j) - s.Position(k), s.Velocity(j) - s.Velocity(k));
      });
      herd->SetAcceleration(k, pairs.Finish(sums));
      herd->neighbours[k] = sums.cohesion.weight;
    });
  };
  if (p.taper > 0) {
    run(MakeBoidsPairs<T>(p, static_cast<T>(p.taper)));
  } else {
    run(MakeBoidsPairs<T>(p, HardEdge{}));
  }
}

BoidsJob MakeJob(const BoidsParameters<double>& p, Herd<float>* herd) {
  const CellGrid<float>::View g = herd->grid.view();
  const Bodies<float>& s = herd->now;
  const auto f = [](double value) { return static_cast<float>(value); };
  return {.start = g.start,
          .low_x = g.low_x,
          .inverse_edge = g.inverse_edge,
          .nx = g.nx,
          .ny = g.ny,
          .nz = g.nz,
          .x = s.x.data(),
          .y = s.y.data(),
          .z = s.z.data(),
          .vx = s.vx.data(),
          .vy = s.vy.data(),
          .vz = s.vz.data(),
          .d_s = f(p.d_s),
          .d_v = f(p.d_v),
          .alpha_s = f(p.alpha_s),
          .alpha_c = f(p.alpha_c),
          .alpha_a = f(p.alpha_a),
          .taper = f(p.taper),
          .reach = f(1.0001 * Reach(p)),
          .ax = herd->ax.data(),
          .ay = herd->ay.data(),
          .az = herd->az.data(),
          .neighbours = herd->neighbours.data()};
}

const BoidsKernelVariant* ChooseKernel(const std::string& name) {
  if (name == "scalar") return nullptr;
  const BoidsKernelVariant* best = nullptr;
  for (const BoidsKernelVariant& variant : kBoidsKernels) {
    if (variant.supported() && (name.empty() || name == variant.name)) best = &variant;
  }
  Check(best != nullptr, "this machine has no kernel `" + name + "`");
  return best;
}

template <typename T>
class BoidsMotion final : public Motion<T> {
 public:
  BoidsMotion(const BoidsParameters<double>& p, const MotionContext& context, const Herd<T>& herd)
      : p_(InSeconds(p)),
        kernel_(std::is_same_v<T, float> ? ChooseKernel(context.kernel) : nullptr),
        forces_(context, herd.size()),
        noise_(Stream::kNoise, herd.size()) {}

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    herd->SortBy(std::max(Reach(p_), forces_.Reach()));
    AddPairs(pool, herd);
    forces_.Add(around, pool, herd);
    pool->For(0, static_cast<std::int64_t>(herd->size()), kAgentGrain,
              [&](std::int64_t first, std::int64_t last) { Move(around, first, last, herd); });
  }
  void Retune(const ModelParameters& parameters) override {
    p_ = InSeconds(std::get<BoidsParameters<double>>(parameters));
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
  void AddPairs(ThreadPool* pool, Herd<T>* herd) const {
    const int rows = herd->grid.view().RowCount();
    if constexpr (std::is_same_v<T, float>) {
      if (kernel_ != nullptr) {
        const BoidsJob job = MakeJob(p_, herd);
        pool->For(0, rows, kRowGrain, [&](std::int64_t first, std::int64_t last) {
          thread_local std::vector<std::uint32_t> candidates;
          candidates.resize(std::max(candidates.size(), herd->size() + 32));
          kernel_->kernel(job, static_cast<int>(first), static_cast<int>(last), candidates.data());
        });
        return;
      }
    }
    pool->For(0, rows, kRowGrain, [&](std::int64_t first, std::int64_t last) {
      BoidsPairsScalar(p_, first, last, herd);
    });
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

  BoidsParameters<double> p_;         // in seconds
  const BoidsKernelVariant* kernel_;  // null: scalar
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
