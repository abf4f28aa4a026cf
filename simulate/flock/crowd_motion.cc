// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/crowd_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "simulate/fields/wall_potential.h"
#include "simulate/flock/force_passes.h"
#include "simulate/flock/streams.h"
#include "simulate/flock/wall_field.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kSortEvery = 16;  // steps; neighbours in space stay neighbours in memory

template <typename T>
class CrowdMotion final : public Motion<T> {
 public:
  CrowdMotion(const CrowdParameters& p, const MotionContext& context, Herd<T>* herd)
      : p_(p),
        world_(context.world),
        species_(context.species),
        threads_(context.pool != nullptr ? context.pool->threads() : 1),
        animals_(herd->size()) {
    for (const GoalSpec& goal : world_->goals) {
      if (IsOwn(goal)) goals_.push_back({GoalPosition(goal, world_->time), goal.reach});
    }
    if (goals_.empty()) {
      RefuseModel(context, "the model crowd has no goal for the species " + species_,
                  "add a [[goal]]");
    }
    PrepareField();
    for (std::size_t k = 0; k < herd->size(); ++k) {
      const Vec3d x = Grounded(ToDouble(herd->now.Position(k)));
      herd->now.Set(k, Cast<T>(x), herd->now.Velocity(k));
    }
  }

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    if (around.step % kSortEvery == 0) herd->SortBy(p_.cell);
    const auto interval =
        static_cast<std::uint32_t>(std::max(1.0, std::round(p_.interval / around.dt())));
    if (around.step % interval == 0) LookAround(around, *herd);
    noise_ = NoiseTermsAt(
        {.gain = p_.gain, .scale = p_.scale, .evolution = p_.evolution, .seed = around.world->seed},
        around.time);
    ForEachAnimal(*herd, pool, [&](std::size_t k) {
      const std::uint32_t agent = herd->now.agent[k];
      const Vec3d x = Grounded(ToDouble(herd->now.Position(k)));
      Vec3d v = field_->Velocity(agent % goals_.size(), x) +
                Noise(x, herd->first_agent + agent, around.step) + around.wind;
      if (ground_) v.z = 0;
      herd->now.Set(k, Cast<T>(x + around.dt() * v), Cast<T>(v));
    });
  }

  bool HasNeighbours() const override { return false; }

  void Retune(const ModelParameters& parameters) override {
    p_ = std::get<CrowdParameters>(parameters);
    PrepareField();
  }

  Room room() const override { return {0.5 * p_.d_min, p_.body_size}; }

  // The field is that of the crowd as it was last looked at.
  void Save(StateWriter* out) const override {
    for (const Ball& goal : goals_) out->Put(goal.centre);
    out->Put(static_cast<std::uint64_t>(positions_.size()));
    out->Put(positions_);
    out->Put(velocities_);
  }
  void Load(StateReader* in) override {
    for (Ball& goal : goals_) in->Take(&goal.centre);
    std::uint64_t size = 0;
    in->Take(&size);
    if (size != 0 && size != animals_) {
      throw std::runtime_error("the saved state is of another flock");
    }
    positions_.resize(size);
    velocities_.resize(size);
    in->Take(&positions_);
    in->Take(&velocities_);
    UpdateField();
  }

 private:
  bool IsOwn(const GoalSpec& goal) const {
    return goal.species.empty() || goal.species == species_;
  }

  Vec3d Grounded(Vec3d x) const {
    if (ground_) x.z = *ground_;
    return x;
  }

  void PrepareField() {
    const Region& box = world_->box;
    ground_.reset();
    if (world_->dimensions == 2) {
      ground_ = 0;
    } else if (box.high.z - box.low.z < p_.cell) {
      ground_ = 0.5 * (box.low.z + box.high.z);
    }
    field_.emplace(WallField(*world_, p_.cell, threads_, ground_), p_.field, Goals(), threads_);
    if (!positions_.empty()) field_->Update(positions_, velocities_);
  }

  // A group each. On the ground a goal counts by where on it it stands.
  std::vector<std::vector<Solid>> Goals() const {
    std::vector<std::vector<Solid>> groups;
    for (const Ball& goal : goals_) {
      groups.push_back({Ball{Grounded(goal.centre), goal.radius}});
    }
    return groups;
  }

  void LookAround(const Surroundings& around, const Herd<T>& herd) {
    std::size_t own = 0;
    for (const GoalSpec& goal : around.goals) {
      if (IsOwn(goal)) goals_[own++].centre = goal.position;
    }
    positions_.resize(herd.size());
    velocities_.resize(herd.size());
    for (std::size_t k = 0; k < herd.size(); ++k) {
      positions_[k] = ToDouble(herd.now.Position(k));
      velocities_[k] = ToDouble(herd.now.Velocity(k));
    }
    UpdateField();
  }

  void UpdateField() {
    field_->SetGoals(Goals());
    field_->Update(positions_, velocities_);
  }

  Vec3d Noise(const Vec3d& x, std::uint64_t agent, std::uint32_t step) const {
    Vec3d sum;
    switch (p_.noise_kind()) {
      case SwarmNoiseKind::kNone:
        break;
      case SwarmNoiseKind::kWhite: {
        Rng rng = StreamOf(Stream::kNoise, world_->seed, agent, step);
        sum = p_.gain / p_.scale * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
        break;
      }
      case SwarmNoiseKind::kPerlin:
        for (const NoiseTerm<double>& term : noise_) sum += PerlinVelocity(term, x);
        break;
      case SwarmNoiseKind::kCurl:
        sum = CurlAmongWalls(x);
        break;
    }
    return sum;
  }

  // On the ground the potential is upright, so that its curl lies in the ground and has no sources
  // there either.
  Vec3d CurlAmongWalls(const Vec3d& x) const {
    PotentialSample<double> n = NoisePotential(noise_, x);
    if (ground_) {
      n.value = {0, 0, n.value.z};
      n.gradient[0] = n.gradient[1] = {};
    }
    const SmoothSample s = field_->distance().SampleSmooth(x);
    const WallDistance<double> wall{
        s.value, s.gradient, {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
    return CurlNearWall(n, wall, p_.cell);
  }

  CrowdParameters p_;
  const World* world_;
  std::string species_;
  int threads_;
  std::size_t animals_;
  std::vector<Ball> goals_;  // of the groups, as the field knows them
  std::optional<double> ground_;
  std::optional<CrowdField> field_;
  std::vector<Vec3d> positions_, velocities_;  // when the crowd was last looked at
  std::vector<NoiseTerm<double>> noise_;       // at this step
};

}  // namespace

template <typename T>
std::unique_ptr<Motion<T>> MakeCrowdMotion(const CrowdParameters& parameters,
                                           const MotionContext& context, Herd<T>* herd) {
  RefuseForces(context, "crowd", "it knows no accelerations");
  return std::make_unique<CrowdMotion<T>>(parameters, context, herd);
}

template std::unique_ptr<Motion<float>> MakeCrowdMotion(const CrowdParameters&,
                                                        const MotionContext&, Herd<float>*);
template std::unique_ptr<Motion<double>> MakeCrowdMotion(const CrowdParameters&,
                                                         const MotionContext&, Herd<double>*);

}  // namespace flocklift
