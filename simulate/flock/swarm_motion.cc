// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/swarm_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "simulate/fields/density.h"
#include "simulate/fields/wall_potential.h"
#include "simulate/flock/force_passes.h"
#include "simulate/flock/streams.h"
#include "simulate/flock/surroundings_forces.h"
#include "simulate/flock/swarm_guide.h"
#include "simulate/flock/swarm_velocity.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kSortEvery = 16;  // steps; neighbours in space stay neighbours in memory
constexpr double kNearWall = 1.3;         // cells; the smoothed distance is asked within

SwarmKernel ChooseSwarmKernel(const std::string& name) {
  if (name.empty()) return FastestSwarmKernel().kernel;
  if (name == "scalar") return SwarmKernelScalar;
  for (const SwarmKernelVariant& variant : kSwarmKernels) {
    if (variant.supported() && name == variant.name) return variant.kernel;
  }
  throw std::invalid_argument("this machine has no kernel `" + name + "`");
}

// Distance to a wall at a point, from the smooth interpolant of a grid.
template <typename T>
WallDistance<T> AsWall(const SmoothSample& s) {
  return {static_cast<T>(s.value),
          Cast<T>(s.gradient),
          {Cast<T>({s.xx, s.xy, s.xz}), Cast<T>({s.xy, s.yy, s.yz}), Cast<T>({s.xz, s.yz, s.zz})}};
}

// ... and to a ball. At its centre there is no normal.
template <typename T>
WallDistance<T> BallWall(const Vec3d& centre, double radius, const Vec3d& x) {
  const Vec3d way = x - centre, n = Normalized(way);
  const double per_metre = Norm(way) > 1e-9 ? 1 / Norm(way) : 0;
  const auto row = [&](double component, const Vec3d& axis) {
    return Cast<T>(per_metre * (axis - component * n));
  };
  return {static_cast<T>(Norm(way) - radius),
          Cast<T>(n),
          {row(n.x, {1, 0, 0}), row(n.y, {0, 1, 0}), row(n.z, {0, 0, 1})}};
}

template <typename T>
class SwarmMotion final : public Motion<T> {
 public:
  SwarmMotion(const SwarmParameters& p, const MotionContext& context, const Herd<T>& herd)
      : p_(p),
        world_(context.world),
        species_(context.species),
        kernel_(ChooseSwarmKernel(context.kernel)),
        distance_(herd.size() + Bodies<T>::kPadding) {
    if (world_->dimensions != 3) {
      RefuseModel(context, "the model swarm needs three dimensions",
                  "set dimensions = 3, or take another model");
    }
    for (GoalSpec goal : OwnGoals(world_->goals)) {
      goal.position = GoalPosition(goal, world_->time);
      goals_.push_back(goal);
    }
    PrepareGuide(context.pool);
  }

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    if (around.step % kSortEvery == 0) herd->SortBy(p_.cell, pool);
    FollowGoals(around);
    if (guide_ && p_.crowding > 0) LookAtCrowds(around, *herd);
    noise_ = NoiseTermsAt(
        {.gain = p_.gain, .scale = p_.scale, .evolution = p_.evolution, .seed = around.world->seed},
        around.time);
    std::vector<SwarmNoise> plain;
    for (const NoiseTerm<double>& term : noise_) {
      plain.push_back({static_cast<float>(term.gain), static_cast<float>(term.scale), term.seed});
    }
    const bool smooth =
        p_.noise_kind() == SwarmNoiseKind::kCurl || p_.noise_kind() == SwarmNoiseKind::kPerlin;
    job_ = {};
    job_.noise = plain.data();
    job_.noise_count = smooth && p_.gain > 0 ? static_cast<int>(plain.size()) : 0;
    job_.curl = p_.noise_kind() == SwarmNoiseKind::kCurl;
    if (guide_) {
      guide_->Cover(herd->now);
      job_.guide = guide_->View(p_.s0);
    }
    pool->For(0, static_cast<std::int64_t>(herd->size()), kAgentGrain,
              [&](std::int64_t first, std::int64_t last) {
                const auto begin = static_cast<std::size_t>(first);
                const auto end = static_cast<std::size_t>(last);
                FillVelocities(begin, end, herd);
                if (guide_ || p_.goal_is_solid()) TurnAtWalls(begin, end, herd);
                AddRest(around, begin, end, herd);
                Advance(static_cast<T>(around.dt()), begin, end, herd);
              });
  }

  bool HasNeighbours() const override { return false; }

  void Retune(const ModelParameters& parameters) override {
    const SwarmParameters& p = std::get<SwarmParameters>(parameters);
    const bool other_guide = p.cell != p_.cell || p.A != p_.A || p.B != p_.B ||
                             p.diagonal != p_.diagonal || p.crowding != p_.crowding;
    p_ = p;
    if (!other_guide) return;
    extra_.clear();
    PrepareGuide(nullptr);
  }

  Room room() const override { return {0.5 * p_.d_min, p_.body_size}; }

  void Save(StateWriter* out) const override {
    for (const GoalSpec& goal : goals_) out->Put(goal.position);
    out->Put(static_cast<std::uint64_t>(extra_.size()));
    out->Put(extra_);
  }
  void Load(StateReader* in) override {
    bool moved = false;
    for (GoalSpec& goal : goals_) {
      const Vec3d before = goal.position;
      in->Take(&goal.position);
      moved |= !(goal.position == before);
    }
    std::uint64_t size = 0;
    in->Take(&size);
    if (size != 0 && (!guide_ || size != guide_->grid().size())) {
      throw std::runtime_error("the saved state is of another flock");
    }
    extra_.resize(size);
    in->Take(&extra_);
    if (!guide_) return;
    if (moved) guide_->SetGoals(goals_);
    if (!extra_.empty()) guide_->SetExtra(extra_);
  }

 private:
  std::vector<GoalSpec> OwnGoals(const std::vector<GoalSpec>& all) const {
    std::vector<GoalSpec> own;
    for (const GoalSpec& goal : all) {
      if (goal.species.empty() || goal.species == species_) own.push_back(goal);
    }
    return own;
  }

  // Neither goals nor obstacles: the animals drift with the noise alone.
  void PrepareGuide(ThreadPool* pool) {
    guide_.reset();
    if (goals_.empty() && world_->obstacles.empty()) return;
    guide_.emplace(
        *world_, p_.cell,
        CostOptions{.length_weight = p_.A, .repulsion_weight = p_.B, .diagonal = p_.diagonal},
        goals_, pool != nullptr ? pool->threads() : 1);
  }

  // The cost follows a goal that has moved by half a cell, or half of its own reach.
  void FollowGoals(const Surroundings& around) {
    const std::vector<GoalSpec> now = OwnGoals(around.goals);
    bool moved = false;
    for (std::size_t k = 0; k < goals_.size(); ++k) {
      moved |=
          Norm(now[k].position - goals_[k].position) > 0.5 * std::max(p_.cell, goals_[k].reach);
    }
    if (!moved) return;
    goals_ = now;
    if (guide_) guide_->SetGoals(goals_);
  }

  void LookAtCrowds(const Surroundings& around, const Herd<T>& herd) {
    const auto interval =
        static_cast<std::uint32_t>(std::max(1.0, std::round(p_.crowding_interval / around.dt())));
    if (around.step % interval != 0) return;
    std::vector<Vec3d> positions;
    for (std::size_t k = 0; k < herd.size(); ++k) {
      positions.push_back(ToDouble(herd.now.Position(k)));
    }
    extra_ = DensityField(guide_->grid(), positions).values;
    for (float& extra : extra_) extra *= static_cast<float>(p_.crowding);
    guide_->SetExtra(extra_);
  }

  void FillVelocities(std::size_t first, std::size_t last, Herd<T>* herd) {
    Bodies<T>& s = herd->now;
    if constexpr (std::is_same_v<T, float>) {
      SwarmJob job = job_;
      job.x = s.x.data();
      job.y = s.y.data();
      job.z = s.z.data();
      job.vx = s.vx.data();
      job.vy = s.vy.data();
      job.vz = s.vz.data();
      job.distance = distance_.data();
      kernel_(job, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
    } else {
      for (std::size_t k = first; k < last; ++k) {
        const Vec3<T> x = s.Position(k);
        Vec3<T> v{};
        for (int n = 0; n < job_.noise_count; ++n) v += SwarmNoiseVelocity(job_, n, x);
        if (guide_) {
          const GuideSample<T> guide = SampleGuide<T>(job_.guide, x);
          v += guide.velocity;
          distance_[k] = guide.distance;
        }
        s.Set(k, x, v);
      }
    }
  }

  // Near a wall the potential is the boundary-aware one; of several walls the nearest counts.
  void TurnAtWalls(std::size_t first, std::size_t last, Herd<T>* herd) {
    if (p_.noise_kind() != SwarmNoiseKind::kCurl || job_.noise_count == 0) return;
    const T near = static_cast<T>(kNearWall * p_.cell);
    std::vector<NoiseTerm<T>> terms;
    for (const NoiseTerm<double>& term : noise_) {
      terms.push_back({static_cast<T>(term.gain), static_cast<T>(term.scale), term.seed});
    }
    for (std::size_t k = first; k < last; ++k) {
      const bool at_wall = guide_ && distance_[k] < near;
      if (!at_wall && !p_.goal_is_solid()) continue;
      const Vec3<T> x = herd->now.Position(k);
      std::optional<WallDistance<T>> wall;
      if (at_wall) wall = AsWall<T>(guide_->distance().SampleSmooth(ToDouble(x)));
      for (const GoalSpec& goal : goals_) {
        if (!p_.goal_is_solid()) continue;
        const WallDistance<T> ball = BallWall<T>(goal.position, goal.reach, ToDouble(x));
        if (!wall || ball.value < wall->value) wall = ball;
      }
      if (!wall || wall->value > static_cast<T>(p_.cell)) continue;
      Vec3<T> v = CurlNearWall(NoisePotential(terms, x), *wall, static_cast<T>(p_.cell));
      if (guide_) v += SampleGuide<T>(job_.guide, x).velocity;
      herd->now.Set(k, x, v);
    }
  }

  // White noise, kicks towards a lamp, and the wind.
  void AddRest(const Surroundings& around, std::size_t first, std::size_t last, Herd<T>* herd) {
    const bool white = p_.noise_kind() == SwarmNoiseKind::kWhite && p_.gain > 0;
    const bool lamp = p_.lamp_probability > 0 && p_.lamp_kick > 0 && !goals_.empty();
    if (!white && !lamp && around.wind == Vec3d{}) return;
    for (std::size_t k = first; k < last; ++k) {
      const Vec3d x = ToDouble(herd->now.Position(k));
      Vec3d v = ToDouble(herd->now.Velocity(k)) + around.wind;
      const std::uint64_t agent = herd->first_agent + herd->now.agent[k];
      if (white) {
        Rng rng = StreamOf(Stream::kNoise, around.world->seed, agent, around.step);
        v += p_.gain / p_.scale * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
      }
      if (lamp) {
        Rng rng = StreamOf(Stream::kKick, around.world->seed, agent, around.step);
        if (rng.Uniform() < p_.lamp_probability) v += p_.lamp_kick * WayToLamp(x);
      }
      herd->now.Set(k, herd->now.Position(k), Cast<T>(v));
    }
  }

  Vec3d WayToLamp(const Vec3d& x) const {
    Vec3d way = goals_.front().position - x;
    for (const GoalSpec& goal : goals_) {
      if (Norm(goal.position - x) < Norm(way)) way = goal.position - x;
    }
    return Normalized(way);
  }

  void Advance(T dt, std::size_t first, std::size_t last, Herd<T>* herd) const {
    T* const x[3] = {herd->now.x.data(), herd->now.y.data(), herd->now.z.data()};
    const T* const v[3] = {herd->now.vx.data(), herd->now.vy.data(), herd->now.vz.data()};
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t k = first; k < last; ++k) x[axis][k] += dt * v[axis][k];
    }
  }

  SwarmParameters p_;
  const World* world_;
  std::string species_;
  SwarmKernel kernel_;
  std::vector<GoalSpec> goals_;  // as the guide knows them
  std::optional<GuideField> guide_;
  std::vector<float> extra_;              // cost of crowds, by node
  std::vector<NoiseTerm<double>> noise_;  // at this step
  SwarmJob job_{};                        // likewise, without the animals
  std::vector<T> distance_;               // to the walls, in the order of the herd [m]
};

}  // namespace

template <typename T>
std::unique_ptr<Motion<T>> MakeSwarmMotion(const SwarmParameters& parameters,
                                           const MotionContext& context, const Herd<T>& herd) {
  RefuseForces(context, "swarm", "it knows no accelerations");
  return std::make_unique<SwarmMotion<T>>(parameters, context, herd);
}

template std::unique_ptr<Motion<float>> MakeSwarmMotion(const SwarmParameters&,
                                                        const MotionContext&, const Herd<float>&);
template std::unique_ptr<Motion<double>> MakeSwarmMotion(const SwarmParameters&,
                                                         const MotionContext&, const Herd<double>&);

}  // namespace flocklift
