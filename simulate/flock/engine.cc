// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/engine.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/flock/herd.h"
#include "simulate/flock/minimum_distance.h"
#include "simulate/flock/motion.h"
#include "simulate/flock/predators.h"
#include "simulate/flock/streams.h"

namespace flocklift {
namespace {

// A species, what it was made from, and what moves it.
template <typename T>
struct Species {
  Swarm swarm;
  Herd<T> herd;
  std::unique_ptr<Motion<T>> motion;
  std::vector<T> bodies;  // room that the bodies need, in the order of the herd [m]
};

template <typename T>
Herd<T> MakeHerd(const Swarm& swarm, std::uint64_t first_agent, bool flat) {
  const std::size_t n = swarm.position.size();
  Check(swarm.velocity.size() == n, "a swarm needs as many velocities as positions");
  Check(swarm.cruising_speed.empty() || swarm.cruising_speed.size() == n,
        "a swarm needs as many cruising speeds as positions, or none");
  Check(swarm.radius.empty() || swarm.radius.size() == n,
        "a swarm needs as many radii as positions, or none");
  Herd<T> herd;
  herd.species = swarm.species;
  herd.first_agent = first_agent;
  herd.now.Resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    herd.now.Set(k, Flattened(flat, Cast<T>(swarm.position[k])),
                 Flattened(flat, Cast<T>(swarm.velocity[k])));
    herd.now.agent[k] = static_cast<std::uint32_t>(k);
    const double speed =
        swarm.cruising_speed.empty() ? Norm(swarm.velocity[k]) : swarm.cruising_speed[k];
    herd.cruising_speed.push_back(static_cast<T>(speed));
    herd.radius.push_back(swarm.radius.empty() ? T(0) : static_cast<T>(swarm.radius[k]));
  }
  for (std::vector<T>* column : {&herd.ax, &herd.ay, &herd.az, &herd.neighbours}) {
    column->assign(n + Bodies<T>::kPadding, T(0));
  }
  return herd;
}

// In an order that depends on nothing, in lanes so that it does not wait for itself.
template <typename T>
double SumOfNeighbours(const Herd<T>& herd) {
  constexpr std::size_t kLanes = 8;
  double lanes[kLanes] = {}, sum = 0;
  const std::size_t n = herd.size(), whole = n - n % kLanes;
  for (std::size_t k = 0; k < whole; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      lanes[lane] += static_cast<double>(herd.neighbours[k + lane]);
    }
  }
  for (std::size_t k = whole; k < n; ++k) sum += static_cast<double>(herd.neighbours[k]);
  for (const double lane : lanes) sum += lane;
  return sum;
}

// What the model finds amiss is a fault of the scene's file, where the species comes from one.
template <typename Work>
auto BlameFile(const ModelSpec& spec, const Work& work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    if (spec.where.empty()) throw;
    throw InputError(spec.where, 0, error.what(), "change the settings of this species");
  }
}

ModelSpec Changed(ModelSpec spec, const ModelSpec& change) {
  if (!change.where.empty()) spec.where = change.where;
  for (const auto& [name, value] : change.parameters) spec.parameters[name] = value;
  for (const auto& [name, word] : change.choices) spec.choices[name] = word;
  for (const auto& [name, where] : change.where_of) spec.where_of[name] = where;
  return spec;
}

bool ChangesModels(const EventSpec& event) {
  return !event.change.parameters.empty() || !event.change.choices.empty();
}

// What is known of an engine's flock from its saved state.
struct SavedHeader {
  std::uint64_t agents = 0, steps = 0;
  double neighbour_sum = 0, touched_sum = 0;
  std::uint64_t next_event = 0;
  Vec3d steady_wind, gust;
};

}  // namespace

template <typename T>
struct BasicEngine<T>::Impl {
  World world;
  ThreadPool pool;
  Predators predators;
  std::vector<Species<T>> species;
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
      Species<T>& added = species.emplace_back();
      added.swarm = swarm;
      added.herd = MakeHerd<T>(swarm, agents, w.dimensions == 2);
      agents += swarm.position.size();
      const MotionContext context{.world = &world,
                                  .species = swarm.species,
                                  .shape = swarm.shape,
                                  .path = swarm.path,
                                  .start_shape = swarm.start_shape,
                                  .forces = &added.swarm.forces,
                                  .kernel = options.kernel,
                                  .pool = &pool,
                                  .where = swarm.spec.where};
      added.motion =
          BlameFile(swarm.spec, [&] { return MakeMotion<T>(swarm.model, context, &added.herd); });
      for (const EventSpec& event : w.events) {  // fails now rather than in the middle
        const bool concerns = event.species.empty() || event.species == swarm.species;
        if (concerns && ChangesModels(event)) ResolveModel(Changed(swarm.spec, event.change));
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
    for (Species<T>& s : species) {
      s.motion->Step(around, &pool, &s.herd);
      neighbour_sum += SumOfNeighbours(s.herd);
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
    for (Species<T>& s : species) {
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
      if (!ChangesModels(event)) continue;
      for (Species<T>& s : species) {
        if (event.species.empty() || event.species == s.swarm.species) Change(event.change, &s);
      }
    }
  }

  static void Change(const ModelSpec& change, Species<T>* s) {
    s->swarm.spec = Changed(s->swarm.spec, change);
    s->swarm.model = ResolveModel(s->swarm.spec);
    BlameFile(s->swarm.spec, [&] { s->motion->Retune(s->swarm.model); });
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
    for (const Species<T>& s : species) {
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
    for (const Species<T>& s : species) {
      for (std::size_t k = 0; k < s.herd.size(); ++k) {
        fn(s.herd.first_agent + s.herd.now.agent[k], s.herd, k);
      }
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
  impl_->ForEach([&state](std::uint64_t agent, const Herd<T>& herd, std::size_t k) {
    state.position[agent] = ToDouble(herd.now.Position(k));
    state.velocity[agent] = ToDouble(herd.now.Velocity(k));
  });
  for (std::size_t k = 0; k < predators.size(); ++k) {
    state.position[impl_->agents + k] = predators[k].position;
    state.velocity[impl_->agents + k] = predators[k].velocity;
  }
  return state;
}

template <typename T>
std::vector<Vec3<float>> BasicEngine<T>::TetrahedraCorners() {
  std::vector<Vec3<float>> corners;
  for (Species<T>& s : impl_->species) s.motion->AppendCorners(&impl_->pool, &corners);
  return corners;
}

template <typename T>
std::vector<Vec3d> BasicEngine<T>::Accelerations() const {
  std::vector<Vec3d> result(impl_->agents + impl_->predators.all().size());
  impl_->ForEach([&result](std::uint64_t agent, const Herd<T>& herd, std::size_t k) {
    result[agent] = ToDouble(herd.Acceleration(k));
  });
  return result;
}

template <typename T>
void BasicEngine<T>::SetParameters(const std::string& species, const ModelSpec& change) {
  for (Species<T>& s : impl_->species) {
    if (s.swarm.species == species) return Impl::Change(change, &s);
  }
  throw std::out_of_range("there is no species " + species);
}
template <typename T>
void BasicEngine<T>::MoveGoal(std::size_t index, const Vec3d& position) {
  impl_->MoveGoal(index, position);
}
template <typename T>
void BasicEngine<T>::MovePredator(std::size_t index, const Vec3d& position) {
  const auto now = impl_->predators.all();
  std::vector<Predator> moved(now.begin(), now.end());
  moved.at(index).position = Flattened(impl_->world.dimensions == 2, position);
  StateWriter out;
  out.Put(moved);
  StateReader in(out.bytes());
  impl_->predators.Load(&in);
}
template <typename T>
void BasicEngine<T>::SetWind(const Vec3d& velocity) {
  impl_->world.wind.velocity = velocity;
}

template <typename T>
std::string BasicEngine<T>::Save() const {
  StateWriter out;
  out.Put(SavedHeader{.agents = impl_->agents,
                      .steps = impl_->steps,
                      .neighbour_sum = impl_->neighbour_sum,
                      .touched_sum = impl_->touched_sum,
                      .next_event = impl_->next_event,
                      .steady_wind = impl_->world.wind.velocity,
                      .gust = impl_->gust});
  for (const GoalSpec& goal : impl_->world.goals) {
    out.Put(goal.position);
    out.Put(goal.waypoints.empty());
  }
  impl_->predators.Save(&out);
  for (const Species<T>& s : impl_->species) {
    const Bodies<T>& b = s.herd.now;
    for (const std::vector<T>* column : {&b.x, &b.y, &b.z, &b.vx, &b.vy, &b.vz}) out.Put(*column);
    out.Put(b.agent);
    s.motion->Save(&out);
  }
  return out.bytes();
}

template <typename T>
void BasicEngine<T>::Load(std::string_view bytes) {
  StateReader in(bytes);
  SavedHeader header;
  in.Take(&header);
  if (header.agents != impl_->agents) {
    throw std::runtime_error("the saved state is of another flock");
  }
  // What events had changed by then is changed again.
  impl_->steps = header.steps;
  impl_->next_event = 0;
  impl_->Happen();
  impl_->next_event = header.next_event;
  impl_->neighbour_sum = header.neighbour_sum;
  impl_->touched_sum = header.touched_sum;
  impl_->world.wind.velocity = header.steady_wind;
  impl_->gust = header.gust;
  for (GoalSpec& goal : impl_->world.goals) {
    in.Take(&goal.position);
    bool follows_no_waypoints = false;
    in.Take(&follows_no_waypoints);
    if (follows_no_waypoints) goal.waypoints.clear();
  }
  impl_->predators.Load(&in);
  for (Species<T>& s : impl_->species) {
    Bodies<T>& b = s.herd.now;
    for (std::vector<T>* column : {&b.x, &b.y, &b.z, &b.vx, &b.vy, &b.vz}) in.Take(column);
    in.Take(&b.agent);
    s.motion->Load(&in);
  }
  if (!in.AtEnd()) throw std::runtime_error("the saved state is of another flock");
}

template <typename T>
std::int64_t BasicEngine<T>::steps() const {
  return static_cast<std::int64_t>(impl_->steps);
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
template <typename T>
double BasicEngine<T>::MdeShare() const {
  const double animal_steps =
      static_cast<double>(impl_->agents) * static_cast<double>(impl_->steps);
  return animal_steps > 0 ? impl_->touched_sum / animal_steps : 0;
}

template class BasicEngine<float>;
template class BasicEngine<double>;

}  // namespace flocklift
