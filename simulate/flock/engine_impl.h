// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The engine's own parts (engine.h), for the files that it is made of.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_ENGINE_IMPL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_ENGINE_IMPL_H_

#include <cmath>
#include <cstdint>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/minimum_distance.h"
#include "simulate/flock/motion.h"
#include "simulate/flock/predators.h"
#include "simulate/flock/species.h"
#include "simulate/flock/streams.h"

namespace flocklift {

template <typename T>
struct BasicEngine<T>::Impl {
  World world;
  ThreadPool pool;
  Predators predators;
  std::vector<internal::Species<T>> species;
  MinimumDistance<T> minimum_distance;
  std::uint64_t agents = 0, steps = 0;
  double neighbour_sum = 0, touched_sum = 0;
  std::size_t next_event = 0;
  Vec3d gust;  // on top of world.wind.velocity

  Impl(const World& w, const std::vector<Swarm>& swarms, const EngineOptions& options)
      : world(w), pool(options.threads), predators(w.predators, w.box, w.dimensions, w.seed) {
    Check(w.dt > 0, "the time step must be positive");
    Check(w.dimensions == 2 || w.dimensions == 3, "there are 2 or 3 dimensions");
    species.reserve(swarms.size());  // motions keep pointers to their swarm
    for (const Swarm& swarm : swarms) {
      internal::Species<T>& added = species.emplace_back();
      added.swarm = swarm;
      added.herd = internal::MakeHerd<T>(swarm, agents, w.dimensions == 2);
      agents += swarm.position.size();
      const MotionContext context{.world = &world,
                                  .species = swarm.species,
                                  .shape = swarm.shape,
                                  .path = swarm.path,
                                  .start_shape = swarm.start_shape,
                                  .settled = &added.swarm.settled,
                                  .forces = &added.swarm.forces,
                                  .kernel = options.kernel,
                                  .pool = &pool,
                                  .where = swarm.spec.where};
      added.motion = internal::BlameFile(
          swarm.spec, [&] { return MakeMotion<T>(swarm.model, context, &added.herd); });
      for (const EventSpec& event : w.events) {  // fails now rather than in the middle
        const bool concerns = event.species.empty() || event.species == swarm.species;
        if (concerns && internal::ChangesModels(event))
          ResolveModel(internal::Changed(swarm.spec, event.change));
      }
    }
    for (const EventSpec& event : w.events) {
      Check(!event.goal || (*event.goal >= 1 && *event.goal <= w.goals.size()),
            "an event moves a goal that is not there");
    }
  }

  double Time() const { return world.time + static_cast<double>(steps) * world.dt; }

  void Step() {
    Happen();
    Blow();
    Surroundings around{.world = &world,
                        .time = Time(),
                        .step = static_cast<std::uint32_t>(steps),
                        .goals = world.goals,
                        .wind = world.wind.velocity + gust,
                        .predators = predators.all()};
    for (GoalSpec& goal : around.goals) goal.position = GoalPosition(goal, around.time);
    for (internal::Species<T>& s : species) {
      s.motion->Step(around, &pool, &s.herd);
      if (s.motion->HasNeighbours()) neighbour_sum += SumOfNeighbours(s.herd, &pool);
      touched_sum += static_cast<double>(s.motion->touched());
    }
    KeepDistance();
    predators.Step(world.dt, static_cast<std::uint32_t>(steps),
                   [this](const Vec3d& from) { return NearestAnimal(from); });
    ++steps;
  }

  // Minimum-distance enforcement for the species that ask for it, all at once.
  void KeepDistance() {
    std::vector<Crowd<T>> crowds;
    for (internal::Species<T>& s : species) {
      const Room room = s.motion->room();
      if (room.distance <= 0 && room.bodies <= 0) continue;
      Bodies<T>& now = s.herd.now;
      s.bodies.resize(room.bodies > 0 ? s.herd.size() : 0);
      for (std::size_t k = 0; k < s.bodies.size(); ++k) {
        s.bodies[k] = static_cast<T>(room.bodies) * s.herd.radius[now.agent[k]];
      }
      crowds.push_back({s.herd.size(), now.x.data(), now.y.data(), now.z.data(),
                        static_cast<T>(room.distance),
                        room.bodies > 0 ? s.bodies.data() : nullptr});
    }
    if (!crowds.empty())
      touched_sum += static_cast<double>(minimum_distance.Enforce(crowds, &pool));
  }

  // The events whose time has come.
  void Happen() {
    for (; next_event < world.events.size(); ++next_event) {
      const EventSpec& event = world.events[next_event];
      if (event.time > Time() + 0.5 * world.dt) return;
      if (event.goal) MoveGoal(*event.goal - 1, event.position);
      if (event.wind) world.wind.velocity = *event.wind;
      if (!internal::ChangesModels(event)) continue;
      for (internal::Species<T>& s : species) {
        if (event.species.empty() || event.species == s.swarm.species) Change(event.change, &s);
      }
    }
  }

  static void Change(const ModelSpec& change, internal::Species<T>* s) {
    s->swarm.spec = internal::Changed(s->swarm.spec, change);
    s->swarm.model = ResolveModel(s->swarm.spec);
    internal::BlameFile(s->swarm.spec, [&] { s->motion->Retune(s->swarm.model); });
  }

  void MoveGoal(std::size_t index, const Vec3d& position) {
    GoalSpec& goal = world.goals.at(index);
    goal.position = position;
    goal.waypoints.clear();
  }

  // The gusts of the wind (simulate/core/scene.h).
  void Blow() {
    const WindSpec& wind = world.wind;
    if (wind.gust <= 0) return;
    Rng rng = StreamOf(Stream::kWind, world.seed, 0, static_cast<std::uint32_t>(steps));
    const double kept = std::exp(-world.dt / wind.gust_time);
    const double fresh = wind.gust * std::sqrt(1 - kept * kept);
    gust = kept * gust + fresh * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
    if (world.dimensions == 2) gust.z = 0;
  }

  // The lowest id wins where two are equally near.
  Vec3d NearestAnimal(const Vec3d& from) const {
    double least = World::kFar;
    std::uint64_t nearest = 0;
    Vec3d position = from;
    for (const internal::Species<T>& s : species) {
      for (std::size_t k = 0; k < s.herd.size(); ++k) {
        const Vec3d x = ToDouble(s.herd.now.Position(k));
        const double squared = SquaredNorm(x - from);
        const std::uint64_t agent = s.herd.first_agent + s.herd.now.agent[k];
        if (squared > least || (squared == least && agent > nearest)) continue;
        least = squared;
        nearest = agent;
        position = x;
      }
    }
    return position;
  }

  // fn(animal's place by id, herd, its place in the herd) for all but the predators.
  template <typename Function>
  void ForEach(const Function& fn) const {
    for (const internal::Species<T>& s : species) {
      for (std::size_t k = 0; k < s.herd.size(); ++k) {
        fn(s.herd.first_agent + s.herd.now.agent[k], s.herd, k);
      }
    }
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_ENGINE_IMPL_H_
