// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/engine.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/flock/bodies.h"
#include "simulate/flock/cell_grid.h"
#include "simulate/flock/integrator.h"
#include "simulate/flock/kernels/boids_kernel.h"
#include "simulate/flock/predators.h"
#include "simulate/flock/streams.h"
#include "simulate/forces/attraction.h"
#include "simulate/forces/flee.h"
#include "simulate/forces/lin.h"
#include "simulate/forces/linear.h"

namespace flocklift {
namespace {

constexpr std::int64_t kRowGrain = 8;       // rows of cells a chunk of work
constexpr std::int64_t kAgentGrain = 1024;  // animals a chunk of work
constexpr double kFearTaper = 0.25;         // of the fear radius

template <typename T>
Vec3<T> Cast(const Vec3d& v) {
  return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}
template <typename T>
Vec3d ToDouble(const Vec3<T>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// One species while it runs. `now` is in the order of the last sort.
template <typename T>
struct Herd {
  std::string species;
  ModelParameters model;  // boids in seconds
  std::uint64_t first_agent = 0;
  Bodies<T> now, sorted;
  CellGrid<T> grid;
  std::vector<T> cruising_speed;  // by agent
  std::vector<Vec3<T>> noise;     // by agent [m/s^2]
  std::vector<T> ax, ay, az;      // of the pair terms, in the order of `sorted` [m/s^2]
  std::vector<T> neighbours;      // likewise
  std::vector<GoalSpec> goals;    // that attract this species
};

// Calls fn(agent k of `sorted`, its row's grid cells' runs) for the rows first_row .. last_row - 1.
template <typename T, typename Function>
void ForEachInRows(const Herd<T>& herd, std::int64_t first_row, std::int64_t last_row,
                   const Function& fn) {
  const auto g = herd.grid.view();
  for (auto row = static_cast<int>(first_row); row < last_row; ++row) {
    const int b = 1 + row % g.ny, c = 1 + row / g.ny;
    for (std::uint32_t k = g.start[g.Cell(1, b, c)]; k < g.start[g.Cell(g.nx, b, c) + 1]; ++k) {
      const int a = g.CellX(herd.sorted.x[k]);
      fn(k, [&](const auto& neighbour) {
        CellGrid<T>::ForEachRun(g, a, a, b, c, [&](std::uint32_t first, std::uint32_t last) {
          for (std::uint32_t j = first; j < last; ++j) {
            if (j != k) neighbour(j);
          }
        });
      });
    }
  }
}

// The kernel's work, one pair at a time.
template <typename T>
void BoidsPairsScalar(const BoidsParameters<double>& p, std::int64_t first_row,
                      std::int64_t last_row, Herd<T>* herd) {
  const auto run = [&](const auto& pairs) {
    using Pairs = std::remove_cvref_t<decltype(pairs)>;
    const Bodies<T>& s = herd->sorted;
    ForEachInRows(*herd, first_row, last_row, [&](std::uint32_t k, const auto& for_neighbours) {
      typename Pairs::Sums sums;
      for_neighbours([&](std::uint32_t j) {
        sums += pairs.Pair(s.Position(j) - s.Position(k), s.Velocity(j) - s.Velocity(k));
      });
      const Vec3<T> acceleration = pairs.Finish(sums);
      herd->ax[k] = acceleration.x;
      herd->ay[k] = acceleration.y;
      herd->az[k] = acceleration.z;
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
  const Bodies<float>& s = herd->sorted;
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

}  // namespace

Vec3d GoalPosition(const GoalSpec& goal, double time) {
  if (goal.period <= 0) return goal.position;
  const double phase = 2 * std::numbers::pi * time / goal.period;
  return goal.position + goal.radius * Vec3d{std::cos(phase), std::sin(phase), 0};
}

template <typename T>
struct BasicEngine<T>::Impl {
  World world;
  const BoidsKernelVariant* kernel;  // null: scalar
  ThreadPool pool;
  Predators predators;
  std::vector<Herd<T>> herds;
  std::int64_t steps = 0;
  double neighbour_sum = 0;
  std::size_t agents = 0;

  Impl(const World& w, const std::vector<Swarm>& swarms, const EngineOptions& options)
      : world(w),
        kernel(std::is_same_v<T, float> ? ChooseKernel(options.kernel) : nullptr),
        pool(options.threads),
        predators(w.predators, w.box, w.dimensions, w.seed) {
    Check(w.dt > 0, "the time step must be positive");
    Check(w.dimensions == 2 || w.dimensions == 3, "there are 2 or 3 dimensions");
    for (const Swarm& swarm : swarms) AddHerd(swarm);
  }

  void AddHerd(const Swarm& swarm) {
    const std::size_t n = swarm.position.size();
    Check(swarm.velocity.size() == n, "a swarm needs as many velocities as positions");
    Check(swarm.cruising_speed.empty() || swarm.cruising_speed.size() == n,
          "a swarm needs as many cruising speeds as positions, or none");
    Herd<T>& herd = herds.emplace_back();
    herd.species = swarm.species;
    herd.model = swarm.model;
    if (auto* p = std::get_if<BoidsParameters<double>>(&herd.model)) *p = InSeconds(*p);
    herd.first_agent = agents;
    agents += n;
    herd.now.Resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      herd.now.Set(k, Flat(Cast<T>(swarm.position[k])), Flat(Cast<T>(swarm.velocity[k])));
      herd.now.agent[k] = static_cast<std::uint32_t>(k);
      const double speed =
          swarm.cruising_speed.empty() ? Norm(swarm.velocity[k]) : swarm.cruising_speed[k];
      herd.cruising_speed.push_back(static_cast<T>(speed));
    }
    herd.noise.resize(n);
    for (std::vector<T>* column : {&herd.ax, &herd.ay, &herd.az, &herd.neighbours}) {
      column->assign(n + Bodies<T>::kPadding, T(0));
    }
    for (const GoalSpec& goal : world.goals) {
      if (goal.species.empty() || goal.species == swarm.species) herd.goals.push_back(goal);
    }
  }

  double Time() const { return world.time + static_cast<double>(steps) * world.dt; }
  Vec3<T> Flat(Vec3<T> v) const {
    if (world.dimensions == 2) v.z = T(0);
    return v;
  }

  void Step() {
    for (Herd<T>& herd : herds) {
      std::visit([&](const auto& parameters) { StepHerd(parameters, &herd); }, herd.model);
      // In the order of the sort, one thread: the same sum always.
      for (std::size_t k = 0; k < herd.sorted.size(); ++k) {
        neighbour_sum += static_cast<double>(herd.neighbours[k]);
      }
      std::swap(herd.now, herd.sorted);
    }
    predators.Step(world.dt, static_cast<std::uint32_t>(steps));
    ++steps;
  }

  // ---- boids ----------------------------------------------------------------------------------

  void StepHerd(const BoidsParameters<double>& p, Herd<T>* herd) {
    herd->grid.Sort(herd->now, Reach(p), &herd->sorted);
    AddPairs(p, herd);
    pool.For(0, static_cast<std::int64_t>(herd->sorted.size()), kAgentGrain,
             [&](std::int64_t first, std::int64_t last) { MoveBoids(p, first, last, herd); });
  }

  void AddPairs(const BoidsParameters<double>& p, Herd<T>* herd) {
    const int rows = herd->grid.view().RowCount();
    if constexpr (std::is_same_v<T, float>) {
      if (kernel != nullptr) {
        const BoidsJob job = MakeJob(p, herd);
        pool.For(0, rows, kRowGrain, [&](std::int64_t first, std::int64_t last) {
          thread_local std::vector<std::uint32_t> candidates;
          candidates.resize(std::max(candidates.size(), herd->sorted.size() + 32));
          kernel->kernel(job, static_cast<int>(first), static_cast<int>(last), candidates.data());
        });
        return;
      }
    }
    pool.For(0, rows, kRowGrain, [&](std::int64_t first, std::int64_t last) {
      BoidsPairsScalar(p, first, last, herd);
    });
  }

  void MoveBoids(const BoidsParameters<double>& p, std::int64_t first, std::int64_t last,
                 Herd<T>* herd) {
    const bool alone = p.alpha_b == 0 && p.cruise == 0 && p.level == 0 && herd->goals.empty() &&
                       predators.all().empty() && p.noise == 0;
    const T dt = static_cast<T>(world.dt);
    const SpeedLimit::Params<T> limit{static_cast<T>(p.s_min), static_cast<T>(p.s_max), T(0)};
    const Vec3<T> low = Cast<T>(world.box.low), high = Cast<T>(world.box.high);
    Bodies<T>& s = herd->sorted;
    if constexpr (std::is_same_v<T, float>) {
      if (alone && world.dimensions == 3 && kernel != nullptr) {
        const MoveJob job{s.x.data(),      s.y.data(),  s.z.data(),      s.vx.data(),
                          s.vy.data(),     s.vz.data(), herd->ax.data(), herd->ay.data(),
                          herd->az.data(), dt,          limit.min,       limit.max};
        kernel->move(job, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
        return;
      }
    }
    for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last); ++k) {
      Vec3<T> x = s.Position(k), v = s.Velocity(k);
      Vec3<T> a{herd->ax[k], herd->ay[k], herd->az[k]};
      if (!alone) {
        const std::uint32_t agent = s.agent[k];
        a += MakeBoidsSelf(p, low, high, herd->cruising_speed[agent]).At(x, v);
        a += Pull(*herd, static_cast<T>(p.goal_range), x, v);
        a += Fear(x);
        if (p.noise > 0) a += Noise(p, herd->first_agent + agent, &herd->noise[agent]);
      }
      Advance(Flat(a), dt, limit, &x, &v);
      s.Set(k, x, v);
    }
  }

  Vec3<T> Pull(const Herd<T>& herd, T range, const Vec3<T>& x, const Vec3<T>& v) const {
    Vec3<T> sum{};
    for (const GoalSpec& goal : herd.goals) {
      const Attraction::Params<T> p{static_cast<T>(goal.weight),
                                    Cast<T>(GoalPosition(goal, Time())), range};
      sum += Attraction::At(p, x, v);
    }
    return sum;
  }

  Vec3<T> Fear(const Vec3<T>& x) const {
    Vec3<T> sum{};
    for (const Predator& predator : predators.all()) {
      const Flee::Params<T> p{static_cast<T>(predator.fear_weight),
                              static_cast<T>(predator.fear_radius),
                              static_cast<T>(kFearTaper * predator.fear_radius)};
      Weighted<T> push;
      push += Flee::Pair(p, Cast<T>(predator.position) - x, Vec3<T>{});
      sum += Flee::Finish(p, push);
    }
    return sum;
  }

  // Ornstein-Uhlenbeck with standard deviation p.noise and correlation time p.noise_time.
  Vec3<T> Noise(const BoidsParameters<double>& p, std::uint64_t agent, Vec3<T>* state) const {
    Rng rng = StreamOf(Stream::kNoise, world.seed, agent, static_cast<std::uint32_t>(steps));
    const double kept = p.noise_time > 0 ? std::exp(-world.dt / p.noise_time) : 0;
    const double fresh = p.noise * std::sqrt(1 - kept * kept);
    const Vec3d draw{rng.Normal(), rng.Normal(), rng.Normal()};
    *state = static_cast<T>(kept) * *state + Cast<T>(fresh * draw);
    return *state;
  }

  // ---- Lin ------------------------------------------------------------------------------------

  void StepHerd(const LinParameters<double>& p, Herd<T>* herd) {
    herd->grid.Sort(herd->now, p.d_sep, &herd->sorted);
    const Bodies<T>& s = herd->sorted;
    const Vec3d sum = SumOfPositions(s);
    pool.For(0, herd->grid.view().RowCount(), kRowGrain,
             [&](std::int64_t first, std::int64_t last) {
               const LinSeparation::Params<T> q{static_cast<T>(p.d_sep), static_cast<T>(p.exponent),
                                                T(0)};
               ForEachInRows(*herd, first, last, [&](std::uint32_t k, const auto& neighbours) {
                 Weighted<T> separation;
                 neighbours([&](std::uint32_t j) {
                   separation += LinSeparation::Pair(q, s.Position(j) - s.Position(k), Vec3<T>{});
                 });
                 herd->neighbours[k] = separation.weight;
                 const Vec3<T> way = WayToTarget(p, q, separation, sum, s, k);
                 herd->ax[k] = way.x;
                 herd->ay[k] = way.y;
                 herd->az[k] = way.z;
               });
             });
    const double kept = p.inertia > 0 ? std::pow(p.inertia, world.dt / p.frame_time) : 0;
    const SpeedLimit::Params<T> limit{T(0), static_cast<T>(p.s_max), T(0)};
    for (std::size_t k = 0; k < s.size(); ++k) {
      Vec3d wanted =
          p.gain / p.frame_time * ToDouble(Vec3<T>{herd->ax[k], herd->ay[k], herd->az[k]});
      for (const GoalSpec& goal : herd->goals) {
        wanted += p.home * goal.weight * (GoalPosition(goal, Time()) - ToDouble(s.Position(k)));
      }
      const Vec3<T> v = SpeedLimit::Limit(
          limit, Flat(static_cast<T>(kept) * s.Velocity(k) + Cast<T>((1 - kept) * wanted)));
      herd->sorted.Set(k, s.Position(k) + static_cast<T>(world.dt) * v, v);
    }
    for (std::vector<T>* column : {&herd->ax, &herd->ay, &herd->az}) {
      std::fill(column->begin(), column->end(), T(0));  // they were no accelerations
    }
  }

  // Cohesion over all others from the sum of all: sum_i (x_i - x_n) = sum_i x_i - N x_n.
  Vec3<T> WayToTarget(const LinParameters<double>& p, const LinSeparation::Params<T>& q,
                      const Weighted<T>& separation, const Vec3d& sum, const Bodies<T>& s,
                      std::size_t k) const {
    const auto n = static_cast<double>(s.size());
    const Vec3d x = ToDouble(s.Position(k));
    const Weighted<T> cohesion{Cast<T>(sum - n * x), static_cast<T>(n - 1)};
    return LinTarget(Vec3<T>{}, static_cast<T>(p.w_sep), LinSeparation::Finish(q, separation),
                     LinCohesion::Finish(LinCohesion::Params<T>{}, cohesion));
  }

  static Vec3d SumOfPositions(const Bodies<T>& s) {
    Vec3d sum;
    for (std::size_t k = 0; k < s.size(); ++k) sum += ToDouble(s.Position(k));
    return sum;
  }

  // ---- linear ---------------------------------------------------------------------------------

  void StepHerd(const LinearParameters<double>& p, Herd<T>* herd) {
    herd->sorted = herd->now;
    Bodies<T>& s = herd->sorted;
    const auto n = static_cast<double>(s.size());
    const Vec3d x_sum = SumOfPositions(s);
    Vec3d v_sum;
    for (std::size_t k = 0; k < s.size(); ++k) v_sum += ToDouble(s.Velocity(k));
    const double diffusion = std::sqrt(2 * p.diffusion * world.dt);
    for (std::size_t k = 0; k < s.size(); ++k) {
      const Vec3d x = ToDouble(s.Position(k)), v = ToDouble(s.Velocity(k));
      const Vec3d a = LinearCohesion::Finish(LinearCohesion::Params<double>{p.cohesion},
                                             Weighted<double>{x_sum - n * x, n - 1}) +
                      LinearAlignment::Finish(LinearAlignment::Params<double>{p.alignment},
                                              Weighted<double>{v_sum - n * v, n - 1});
      Rng rng = StreamOf(Stream::kNoise, world.seed, herd->first_agent + s.agent[k],
                         static_cast<std::uint32_t>(steps));
      const Vec3d kick = diffusion * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
      const Vec3<T> faster = Flat(Cast<T>(v + world.dt * a + kick));
      s.Set(k, Cast<T>(x + world.dt * ToDouble(faster)), faster);
      herd->neighbours[k] = static_cast<T>(n - 1);
    }
  }
};

template <typename T>
BasicEngine<T>::BasicEngine(const World& world, const std::vector<Swarm>& swarms,
                            const EngineOptions& options)
    : impl_(std::make_unique<Impl>(world, swarms, options)) {}
template <typename T>
BasicEngine<T>::~BasicEngine() = default;
template <typename T>
BasicEngine<T>::BasicEngine(BasicEngine&&) noexcept = default;
template <typename T>
BasicEngine<T>& BasicEngine<T>::operator=(BasicEngine&&) noexcept = default;

template <typename T>
void BasicEngine<T>::Step() {
  impl_->Step();
}

template <typename T>
FlockState BasicEngine<T>::State() const {
  const auto predators = impl_->predators.all();
  const std::size_t n = impl_->agents + predators.size();
  FlockState state;
  state.id.resize(n);
  state.position.resize(n);
  state.velocity.resize(n);
  for (std::size_t k = 0; k < n; ++k) state.id[k] = static_cast<Id>(k + 1);
  for (const Herd<T>& herd : impl_->herds) {
    for (std::size_t k = 0; k < herd.now.size(); ++k) {
      const std::size_t agent = herd.first_agent + herd.now.agent[k];
      state.position[agent] = ToDouble(herd.now.Position(k));
      state.velocity[agent] = ToDouble(herd.now.Velocity(k));
    }
  }
  for (std::size_t k = 0; k < predators.size(); ++k) {
    state.position[impl_->agents + k] = predators[k].position;
    state.velocity[impl_->agents + k] = predators[k].velocity;
  }
  return state;
}

template <typename T>
std::vector<Vec3d> BasicEngine<T>::PairAccelerations() const {
  std::vector<Vec3d> result(impl_->agents + impl_->predators.all().size());
  for (const Herd<T>& herd : impl_->herds) {
    for (std::size_t k = 0; k < herd.now.size(); ++k) {
      result[herd.first_agent + herd.now.agent[k]] =
          ToDouble(Vec3<T>{herd.ax[k], herd.ay[k], herd.az[k]});
    }
  }
  return result;
}

template <typename T>
std::int64_t BasicEngine<T>::steps() const {
  return impl_->steps;
}
template <typename T>
double BasicEngine<T>::time() const {
  return impl_->Time();
}
template <typename T>
double BasicEngine<T>::MeanNeighbours() const {
  const double animal_steps =
      static_cast<double>(impl_->agents) * static_cast<double>(impl_->steps);
  return animal_steps > 0 ? impl_->neighbour_sum / animal_steps : 0;
}

template class BasicEngine<float>;
template class BasicEngine<double>;

}  // namespace flocklift
