// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/force_passes.h"

#include <algorithm>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/fields/curl_noise.h"
#include "simulate/flock/correlated_noise.h"
#include "simulate/flock/force_types.h"
#include "simulate/flock/surroundings_forces.h"
#include "simulate/forces/alignment.h"
#include "simulate/forces/boundary.h"
#include "simulate/forces/cohesion.h"
#include "simulate/forces/level.h"
#include "simulate/forces/lin.h"
#include "simulate/forces/separation.h"
#include "simulate/forces/speed.h"

namespace flocklift {
namespace {

// A pair term, one pair at a time.
template <typename T, typename Term>
class PairPass final : public ForcePass<T> {
 public:
  using Params = typename Term::template Params<T>;

  PairPass(const Params& params, double gain, const NeighbourForce& edge)
      : params_(params), gain_(static_cast<T>(gain)), reach_(edge.radius + 0.5 * edge.taper) {}

  double Reach() const override { return reach_; }
  void Add(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    const Bodies<T>& s = herd->now;
    ForEachWithNeighbours(*herd, pool, [&](std::uint32_t k, const auto& for_neighbours) {
      Weighted<T> sum;
      for_neighbours([&](std::uint32_t j) {
        sum += Term::Pair(params_, s.Position(j) - s.Position(k), s.Velocity(j) - s.Velocity(k));
      });
      const Vec3<T> a = gain_ * Term::Finish(params_, sum);
      herd->SetAcceleration(k, herd->Acceleration(k) + Flattened(around.flat(), a));
      herd->neighbours[k] = std::max(herd->neighbours[k], sum.weight);
    });
  }

 private:
  Params params_;
  T gain_;
  double reach_;
};

// What fn(around, herd, k) returns for each animal k.
template <typename T, typename Function>
class AgentPass final : public ForcePass<T> {
 public:
  explicit AgentPass(Function fn) : fn_(std::move(fn)) {}
  void Add(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    ForEachAnimal(*herd, pool, [&](std::size_t k) {
      herd->SetAcceleration(
          k, herd->Acceleration(k) + Flattened(around.flat(), fn_(around, *herd, k)));
    });
  }

 private:
  Function fn_;
};
template <typename T, typename Function>
std::unique_ptr<ForcePass<T>> MakeAgentPass(Function fn) {
  return std::make_unique<AgentPass<T, Function>>(std::move(fn));
}

template <typename T>
class NoisePass final : public ForcePass<T> {
 public:
  NoisePass(const NoiseForce& p, std::size_t animals)
      : p_(p), noise_(Stream::kForceNoise, animals) {}
  void Add(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    ForEachAnimal(*herd, pool, [&](std::size_t k) {
      const Vec3<T> a = noise_.Next(around, herd->first_agent, herd->now.agent[k], p_.sd, p_.time);
      herd->SetAcceleration(k, herd->Acceleration(k) + Flattened(around.flat(), a));
    });
  }
  void Save(StateWriter* out) const override { out->Put(noise_.state()); }
  void Load(StateReader* in) override { in->Take(&noise_.state()); }

 private:
  NoiseForce p_;
  CorrelatedNoise<T> noise_;
};

// One overload for each type of force_types.h.
template <typename T>
struct MakePass {
  using Pass = std::unique_ptr<ForcePass<T>>;
  std::size_t animals;

  static T F(double value) { return static_cast<T>(value); }

  Pass operator()(const SeparationForce& p) const {
    return std::make_unique<PairPass<T, Separation>>(
        Separation::Params<T>{F(p.gain), F(p.radius), F(p.taper)}, 1, p);
  }
  Pass operator()(const CohesionForce& p) const {
    return std::make_unique<PairPass<T, Cohesion>>(
        Cohesion::Params<T>{F(p.gain), F(p.radius), F(p.taper)}, 1, p);
  }
  Pass operator()(const AlignmentForce& p) const {
    return std::make_unique<PairPass<T, Alignment>>(
        Alignment::Params<T>{F(p.gain), F(p.radius), F(p.taper)}, 1, p);
  }
  Pass operator()(const RepulsionForce& p) const {
    return std::make_unique<PairPass<T, LinSeparation>>(
        LinSeparation::Params<T>{F(p.radius), F(p.exponent), F(p.taper)}, p.gain, p);
  }
  Pass operator()(const GoalForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings& around, const Herd<T>& herd, std::size_t k) {
      return GoalPull(around, herd, F(p.range), herd.now.Position(k), herd.now.Velocity(k));
    });
  }
  Pass operator()(const WallForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings& around, const Herd<T>& herd, std::size_t k) {
      const Region& box = around.world->box;
      const Boundary::Params<T> walls{F(p.gain), Cast<T>(box.low), Cast<T>(box.high), F(p.taper)};
      return Boundary::At(walls, herd.now.Position(k), herd.now.Velocity(k));
    });
  }
  Pass operator()(const CruiseForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings&, const Herd<T>& herd, std::size_t k) {
      const CruiseSpeed::Params<T> q{F(p.rate), herd.cruising_speed[herd.now.agent[k]]};
      return CruiseSpeed::At(q, herd.now.Position(k), herd.now.Velocity(k));
    });
  }
  Pass operator()(const LevelForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings&, const Herd<T>& herd, std::size_t k) {
      return Level::At(Level::Params<T>{F(p.rate)}, herd.now.Position(k), herd.now.Velocity(k));
    });
  }
  Pass operator()(const FleeForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings& around, const Herd<T>& herd, std::size_t k) {
      return F(p.gain) * Fear(around, herd.now.Position(k));
    });
  }
  Pass operator()(const WindForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings& around, const Herd<T>& herd, std::size_t k) {
      return F(p.rate) * (Cast<T>(around.wind) - herd.now.Velocity(k));
    });
  }
  Pass operator()(const DragForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings&, const Herd<T>& herd, std::size_t k) {
      return F(-p.rate) * herd.now.Velocity(k);
    });
  }
  Pass operator()(const GravityForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings&, const Herd<T>&, std::size_t) {
      return Vec3<T>{T(0), T(0), F(-p.g)};
    });
  }
  Pass operator()(const CurlForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings& around, const Herd<T>& herd, std::size_t k) {
      return CurlNoise(Field(p, around), herd.now.Position(k));
    });
  }
  Pass operator()(const PerlinForce& p) const {
    return MakeAgentPass<T>([p](const Surroundings& around, const Herd<T>& herd, std::size_t k) {
      return PerlinVelocity(Field(p, around), herd.now.Position(k));
    });
  }
  static NoiseTerm<T> Field(const FieldNoiseForce& p, const Surroundings& around) {
    return {F(p.gain), F(p.scale), static_cast<std::uint32_t>(around.world->seed)};
  }
  Pass operator()(const NoiseForce& p) const { return std::make_unique<NoisePass<T>>(p, animals); }
};

}  // namespace

template <typename T>
ForcePasses<T>::ForcePasses(const MotionContext& context, std::size_t animals) {
  if (context.forces == nullptr) return;
  for (const ModelSpec& spec : *context.forces) {
    passes_.push_back(std::visit(MakePass<T>{animals}, ResolveForce(spec)));
  }
}

template <typename T>
double ForcePasses<T>::Reach() const {
  double reach = 0;
  for (const auto& pass : passes_) reach = std::max(reach, pass->Reach());
  return reach;
}

template <typename T>
void ForcePasses<T>::Add(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) {
  for (const auto& pass : passes_) pass->Add(around, pool, herd);
}

template <typename T>
void ForcePasses<T>::Save(StateWriter* out) const {
  for (const auto& pass : passes_) pass->Save(out);
}

template <typename T>
void ForcePasses<T>::Load(StateReader* in) {
  for (const auto& pass : passes_) pass->Load(in);
}

void RefuseForces(const MotionContext& context, const std::string& model, const std::string& why) {
  if (context.forces == nullptr || context.forces->empty()) return;
  throw InputError(context.forces->front().where, 0,
                   "model " + model + " takes no [[species.force]]: " + why,
                   "take the force out, or another model, such as forces");
}

template class ForcePasses<float>;
template class ForcePasses<double>;

}  // namespace flocklift
