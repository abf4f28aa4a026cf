// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/population.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/flock/load_scene.h"
#include "simulate/flock/streams.h"

namespace flocklift {
namespace {

constexpr double kStartSpread = 0.2;   // of the headings [rad]
constexpr double kPredatorSize = 1.5;  // against the first species
constexpr double kMostSpread = 2.5;    // individuals beyond so many sd are drawn in

// Standard normal draws with mean exactly 0 (and none beyond kMostSpread, before centring).
std::vector<double> CentredNormals(std::uint64_t seed, std::size_t first_agent, int count,
                                   int which) {
  std::vector<double> draws(static_cast<std::size_t>(count));
  double sum = 0;
  for (std::size_t k = 0; k < draws.size(); ++k) {
    Rng rng = StreamOf(Stream::kBody, seed, first_agent + k, static_cast<std::uint32_t>(which));
    draws[k] = std::clamp(rng.Normal(), -kMostSpread, kMostSpread);
    sum += draws[k];
  }
  for (double& draw : draws) draw -= sum / static_cast<double>(count);
  return draws;
}

// Where the flock heads at first: for its goal, if it has one.
Vec3d CommonHeading(const Scene& scene, const SpeciesSpec& species, const Region& start,
                    std::size_t species_index, double time) {
  for (const GoalSpec& goal : scene.goals) {
    if (!goal.species.empty() && goal.species != species.name) continue;
    Vec3d way = GoalPosition(goal, time) - start.Center();
    if (scene.dimensions == 2) way.z = 0;
    if (Norm(way) > 1e-9) return Normalized(way);
  }
  Rng rng = StreamOf(Stream::kFlock, scene.seed, species_index);
  const double angle = rng.Uniform(0, 2 * std::numbers::pi);
  return {std::cos(angle), std::sin(angle), 0};
}

Region StartRegion(const Scene& scene, const SpeciesSpec& species) {
  if (species.start) return *species.start;
  const Vec3d quarter = 0.25 * (scene.box.high - scene.box.low);
  return {scene.box.low + quarter, scene.box.high - quarter};
}

Vec3d DrawIn(const Region& region, Rng* rng) {
  return {rng->Uniform(region.low.x, region.high.x), rng->Uniform(region.low.y, region.high.y),
          rng->Uniform(region.low.z, region.high.z)};
}

std::optional<SurfaceDraw> StartShape(const SpeciesSpec& species, const World& world) {
  for (const ShapeInTime& shape : world.shapes) {
    if (shape.name == species.start_shape) return SurfaceDraw(shape.meshes.front());
  }
  return {};
}

Animal MakeAnimal(const SpeciesSpec& species, std::uint64_t seed, std::size_t agent, double size) {
  Rng rng = StreamOf(Stream::kBody, seed, agent, 2);
  return {.id = static_cast<Id>(agent + 1),
          .wingspan = species.wingspan * size,
          .body_length = species.body_length * size,
          .wingbeat_hz = species.wingbeat_hz * rng.Uniform(0.95, 1.05),
          .wingbeat_phase = rng.Uniform(0, 2 * std::numbers::pi)};
}

void AddSpecies(const Scene& scene, std::size_t species_index, Population* population) {
  const SpeciesSpec& species = scene.species[species_index];
  Check(species.count >= 0, "a species cannot have fewer than 0 animals");
  if (species.count == 0) return;
  const std::size_t first = population->animals.size();
  const bool linear = species.model.name == "linear";
  const Region start = StartRegion(scene, species);
  const Vec3d heading = CommonHeading(scene, species, start, species_index, population->world.time);

  const std::optional<SurfaceDraw> start_shape = StartShape(species, population->world);

  const std::vector<double> size_draws = CentredNormals(scene.seed, first, species.count, 0);
  const std::vector<double> speed_draws = CentredNormals(scene.seed, first, species.count, 1);
  double mean_size = 0;
  for (const double draw : size_draws) {
    mean_size += std::exp(species.wingspan_spread * draw) / static_cast<double>(species.count);
  }
  Swarm swarm;
  swarm.species = species.name;
  swarm.model = ResolveModel(species.model);
  swarm.spec = species.model;
  swarm.shape = species.shape;
  swarm.path = species.path;
  swarm.start_shape = species.start_shape;
  swarm.forces = species.forces;
  for (std::size_t k = 0; k < size_draws.size(); ++k) {
    const std::size_t agent = first + k;
    const double size = std::exp(species.wingspan_spread * size_draws[k]) / mean_size;
    population->animals.push_back(MakeAnimal(species, scene.seed, agent, size));
    swarm.radius.push_back(0.5 * population->animals.back().wingspan);

    const double speed = species.speed * std::max(0.1, 1 + species.speed_spread * speed_draws[k]);
    Rng rng = StreamOf(Stream::kStart, scene.seed, agent);
    if (linear) {
      swarm.position.push_back(start.Center() + Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
      swarm.velocity.push_back(0.3 * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
    } else {
      swarm.position.push_back(start_shape ? start_shape->Draw(&rng) : DrawIn(start, &rng));
      Vec3d aside{rng.Normal(), rng.Normal(), 0.3 * rng.Normal()};
      if (scene.dimensions == 2) aside.z = 0;
      swarm.velocity.push_back(speed * Normalized(heading + kStartSpread * aside));
    }
    swarm.cruising_speed.push_back(speed);
  }
  population->swarms.push_back(std::move(swarm));
}

}  // namespace

Population Populate(const Scene& scene) {
  Check(scene.fps > 0 && scene.substeps > 0, "a scene needs frames and steps");
  Check(scene.duration >= 0 && scene.warmup >= 0, "a scene cannot run backwards");
  Population population;
  population.world = {.seed = scene.seed,
                      .dt = 1 / (scene.fps * scene.substeps),
                      .time = 0,
                      .duration = scene.duration,
                      .dimensions = scene.dimensions,
                      .box = scene.box,
                      .goals = scene.goals,
                      .predators = scene.predators,
                      .obstacles = LoadObstacles(scene),
                      .shapes = LoadShapes(scene),
                      .paths = scene.paths,
                      .wind = scene.wind,
                      .events = scene.events};
  const auto warmup_steps =
      static_cast<double>(std::llround(scene.warmup * scene.fps) * scene.substeps);
  population.world.time = -warmup_steps * population.world.dt;
  for (std::size_t k = 0; k < scene.species.size(); ++k) AddSpecies(scene, k, &population);

  const SpeciesSpec hunted = scene.species.empty() ? SpeciesSpec{} : scene.species.front();
  for (const PredatorSpec& predators : scene.predators) {
    for (int k = 0; k < predators.count; ++k) {
      Animal predator = MakeAnimal(hunted, scene.seed, population.animals.size(), kPredatorSize);
      predator.wingbeat_hz /= kPredatorSize;
      population.animals.push_back(predator);
    }
  }
  return population;
}

}  // namespace flocklift
