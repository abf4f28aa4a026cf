// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/bswarm_motion.h"

#include <algorithm>
#include <type_traits>

#include "simulate/fields/curl_noise.h"
#include "simulate/flock/correlated_noise.h"
#include "simulate/flock/force_passes.h"
#include "simulate/flock/orca.h"
#include "simulate/flock/pair_forces.h"
#include "simulate/flock/surroundings_forces.h"
#include "simulate/forces/boundary.h"
#include "simulate/forces/speed.h"

namespace flocklift {
namespace {

constexpr int kMostAvoided = 16;
constexpr double kGradientStep = 1e-4;  // of an obstacle's distance [m]

template <typename T>
class BSwarmMotion final : public Motion<T> {
 public:
  BSwarmMotion(const BSwarmParameters& p, const MotionContext& context, const Herd<T>& herd)
      : p_(p),
        kernel_(std::is_same_v<T, float> ? ChooseKernel(context.kernel) : nullptr),
        forces_(context, herd.size()),
        noise_(Stream::kNoise, herd.size()),
        near_(herd.size()) {
    if (MayList()) lists_.Reserve(ListReach(), context.world->dt, kernel_, context.pool, herd.now);
  }

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    AddNeighbours(around, pool, herd);
    forces_.Add(around, pool, herd);
    const auto eddies = Eddies(around);
    const SpeedLimit::Params<T> limit{T(0), F(p_.s_max), T(0)};
    wanted_.resize(herd->size());
    ForEachAnimal(*herd, pool, [&](std::size_t k) {
      const Vec3<T> a = herd->Acceleration(k) + FromWorld(around, eddies, *herd, k);
      herd->SetAcceleration(k, Flattened(around.flat(), a));
      wanted_[k] =
          SpeedLimit::Limit(limit, herd->now.Velocity(k) + F(around.dt()) * herd->Acceleration(k));
    });
    if (Avoids(Avoidance::kOrca)) Avoid(around, pool, herd);
    ForEachAnimal(*herd, pool, [&](std::size_t k) {
      const Vec3<T> v = Flattened(around.flat(), wanted_[k]);
      herd->now.Set(k, herd->now.Position(k) + F(around.dt()) * v, v);
    });
  }
  void Retune(const ModelParameters& parameters) override {
    p_ = std::get<BSwarmParameters>(parameters);
  }
  Room room() const override { return Avoids(Avoidance::kDistance) ? Room{p_.room, 1.0} : Room{}; }
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
  struct Near {
    Vec3<T> acceleration;
    T neighbours;
  };
  static T F(double value) { return static_cast<T>(value); }
  bool Avoids(Avoidance how) const { return p_.avoid.index == static_cast<int>(how); }

  // Does nothing else need an order of its own?
  bool MayList() const { return p_.most == 0 && forces_.Reach() <= 0 && !Avoids(Avoidance::kOrca); }

  NearReach<T> ListReach() const { return {F(Reach(p_.zones)), T(0)}; }

  // The three zones, from lists that are kept where they last. With a sample, repulsion still hears
  // everybody who is near: a pass of its own in an order of its own, whose result is kept by
  // animal.
  void AddNeighbours(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) {
    if (MayList() && lists_.UpdateIfWorth(ListReach(), around.dt(), kernel_, pool, herd)) {
      PairTask<T> task = TaskOf(herd);
      task.lists = &lists_;
      return SumPairs<T>(p_.zones, kernel_, task, pool);
    }
    ZoneParameters far = p_.zones;
    if (p_.most > 0) {
      ZoneParameters near = p_.zones;
      near.r_ali = near.r_att = near.r_rep;
      herd->SortBy(Reach(near), pool);
      SumPairs<T>(near, kernel_, TaskOf(herd), pool);
      ForEachAnimal(*herd, pool, [&](std::size_t k) {
        near_[herd->now.agent[k]] = {herd->Acceleration(k), herd->neighbours[k]};
      });
      far.w_rep = 0;
    }
    herd->SortBy(std::max(Reach(far), forces_.Reach()), pool);
    PairTask<T> task = TaskOf(herd);
    if (p_.most > 0) {
      SampleRows(herd->grid, static_cast<std::uint32_t>(std::max(1.0, p_.most)), around.step,
                 &sample_);
      task.sample = &sample_;
    }
    SumPairs<T>(far, kernel_, task, pool);
    if (p_.most == 0) return;
    ForEachAnimal(*herd, pool, [&](std::size_t k) {
      const Near& near = near_[herd->now.agent[k]];
      herd->SetAcceleration(k, herd->Acceleration(k) + near.acceleration);
      herd->neighbours[k] += near.neighbours;
    });
  }

  // The curl noise of this moment; empty: none.
  std::vector<NoiseTerm<T>> Eddies(const Surroundings& around) const {
    std::vector<NoiseTerm<T>> terms;
    if (p_.curl_gain == 0) return terms;
    const NoiseOptions options{.gain = p_.curl_gain,
                               .scale = p_.curl_scale,
                               .evolution = p_.curl_evolution,
                               .octaves = 1,
                               .seed = around.world->seed};
    for (const NoiseTerm<double>& term : NoiseTermsAt(options, around.time)) {
      terms.push_back({F(term.gain), F(term.scale), term.seed});
    }
    return terms;
  }

  Vec3<T> FromWorld(const Surroundings& around, const std::vector<NoiseTerm<T>>& eddies,
                    const Herd<T>& herd, std::size_t k) {
    const Vec3<T> x = herd.now.Position(k), v = herd.now.Velocity(k);
    const std::uint32_t agent = herd.now.agent[k];
    const Region& box = around.world->box;
    const Boundary::Params<T> walls{F(p_.alpha_b), Cast<T>(box.low), Cast<T>(box.high),
                                    F(p_.wall_taper)};
    Vec3<T> a = Boundary::At(walls, x, v) + F(p_.escape) * Fear(around, x);
    a += Drive(around, herd, x, v, herd.cruising_speed[agent]);
    if (!eddies.empty()) a += Curl(NoisePotential(eddies, x));
    if (p_.noise > 0) a += noise_.Next(around, herd.first_agent, agent, p_.noise, p_.noise_time);
    return a;
  }

  // Self-propulsion: own speed towards the goals (weighted, until they are reached), or onwards.
  Vec3<T> Drive(const Surroundings& around, const Herd<T>& herd, const Vec3<T>& x, const Vec3<T>& v,
                const T& speed) const {
    Vec3<T> way{};
    bool has_goal = false;
    ForEachGoal(around, herd, [&](const GoalSpec& goal) {
      const Vec3<T> to_goal = Cast<T>(goal.position) - x;
      has_goal = true;
      if (Dot(to_goal, to_goal) > F(goal.reach * goal.reach)) {
        way += F(goal.weight) * SoftUnit(to_goal);
      }
    });
    if (!has_goal) return CruiseSpeed::At({F(p_.drive), speed}, x, v);
    return F(p_.drive) * (speed * SoftUnit(way) - v);
  }

  // Collision-free velocities, found in the order of cells as wide as what is to be avoided.
  void Avoid(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) {
    by_agent_.resize(herd->size());
    for (std::size_t k = 0; k < herd->size(); ++k) {
      by_agent_[herd->now.agent[k]] = {wanted_[k], herd->Acceleration(k), herd->neighbours[k]};
    }
    herd->SortBy(p_.sight, pool);
    for (std::size_t k = 0; k < herd->size(); ++k) {
      const Wanted& wanted = by_agent_[herd->now.agent[k]];
      wanted_[k] = wanted.velocity;
      herd->SetAcceleration(k, wanted.acceleration);
      herd->neighbours[k] = wanted.neighbours;
    }
    radius_ = herd->radius;
    for (T& radius : radius_) radius += F(p_.room);
    const OrcaOptions options{.horizon = p_.horizon,
                              .max_speed = p_.s_max,
                              .sight = p_.sight,
                              .most_neighbours = kMostAvoided};
    AddWalls walls;
    if (around.flat() || !around.world->obstacles.empty()) {
      walls = [&](std::size_t k, std::vector<HalfSpace>* allowed) {
        if (around.flat()) {  // neither up nor down
          allowed->push_back({{}, {0, 0, 1}});
          allowed->push_back({{}, {0, 0, -1}});
        }
        AvoidObstacles(around, ToDouble(herd->now.Position(k)),
                       static_cast<double>(radius_[herd->now.agent[k]]), allowed);
      };
    }
    AvoidCollisions(options, around.dt(), herd->grid, herd->now, radius_, walls, pool, &wanted_);
  }

  void AvoidObstacles(const Surroundings& around, const Vec3d& x, double radius,
                      std::vector<HalfSpace>* allowed) const {
    for (const Obstacle& obstacle : around.world->obstacles) {
      const Block bounds = Bounds(obstacle.solid);
      if (bounds(x) > p_.sight) continue;
      const auto distance = [&](const Vec3d& p) { return SignedDistance(obstacle.solid, p); };
      const double here = distance(x);
      if (here > p_.sight) continue;
      const double h = kGradientStep;
      const Vec3d gradient{distance(x + Vec3d{h, 0, 0}) - distance(x - Vec3d{h, 0, 0}),
                           distance(x + Vec3d{0, h, 0}) - distance(x - Vec3d{0, h, 0}),
                           distance(x + Vec3d{0, 0, h}) - distance(x - Vec3d{0, 0, h})};
      if (Norm(gradient) < h) continue;  // on a ridge there is no way out
      allowed->push_back(AvoidWall(Normalized(gradient), here, radius, p_.horizon));
    }
  }

  struct Wanted {
    Vec3<T> velocity, acceleration;
    T neighbours;
  };

  BSwarmParameters p_;
  const KernelVariant* kernel_;  // null: scalar
  VerletLists<T> lists_{kListSkin};
  ForcePasses<T> forces_;
  CorrelatedNoise<T> noise_;
  std::vector<RowSample> sample_;
  std::vector<Near> near_;        // by agent
  std::vector<Vec3<T>> wanted_;   // velocities, in the order of the herd [m/s]
  std::vector<Wanted> by_agent_;  // the same and the rest, by agent
  std::vector<T> radius_;         // by agent, with the room around it [m]
};

}  // namespace

template <typename T>
std::unique_ptr<Motion<T>> MakeBSwarmMotion(const BSwarmParameters& parameters,
                                            const MotionContext& context, const Herd<T>& herd) {
  return std::make_unique<BSwarmMotion<T>>(parameters, context, herd);
}

template std::unique_ptr<Motion<float>> MakeBSwarmMotion(const BSwarmParameters&,
                                                         const MotionContext&, const Herd<float>&);
template std::unique_ptr<Motion<double>> MakeBSwarmMotion(const BSwarmParameters&,
                                                          const MotionContext&,
                                                          const Herd<double>&);

}  // namespace flocklift
