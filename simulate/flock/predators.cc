// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/predators.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/flock/streams.h"

namespace flocklift {
namespace {

constexpr double kTurnRate = 2;         // of the velocity towards the heading [1/s]
constexpr double kVerticalShare = 0.3;  // climbing and sinking against level flight

Vec3d RandomHeading(int dimensions, Rng* rng) {
  Vec3d heading{rng->Normal(), rng->Normal(), 0};
  if (dimensions == 3) heading.z = kVerticalShare * rng->Normal();
  return Normalized(heading);
}

bool Inside(const Region& box, const Vec3d& p, int dimensions) {
  return p.x > box.low.x && p.x < box.high.x && p.y > box.low.y && p.y < box.high.y &&
         (dimensions == 2 || (p.z > box.low.z && p.z < box.high.z));
}

}  // namespace

Predators::Predators(const std::vector<PredatorSpec>& specs, const Region& box, int dimensions,
                     std::uint64_t seed)
    : box_(box), dimensions_(dimensions), seed_(seed) {
  for (const PredatorSpec& spec : specs) {
    Check(std::isfinite(SquaredNorm(box.low)) && std::isfinite(SquaredNorm(box.high)),
          "predators need a finite box");
    for (int k = 0; k < spec.count; ++k) {
      Rng rng = StreamOf(Stream::kPredator, seed, predators_.size());
      Predator p;
      p.speed = spec.speed;
      p.fear_radius = spec.fear_radius;
      p.fear_weight = spec.fear_weight;
      p.turn_interval = spec.turn_interval;
      p.chases = spec.chases;
      p.position = {rng.Uniform(box.low.x, box.high.x), rng.Uniform(box.low.y, box.high.y),
                    dimensions == 3 ? rng.Uniform(box.low.z, box.high.z) : 0};
      p.heading = RandomHeading(dimensions, &rng);
      p.velocity = p.speed * p.heading;
      p.until_turn = p.turn_interval * rng.Uniform(0.5, 1.5);
      predators_.push_back(p);
    }
  }
}

void Predators::Step(double dt, std::uint32_t step,
                     const std::function<Vec3d(const Vec3d&)>& nearest_animal) {
  for (std::size_t k = 0; k < predators_.size(); ++k) {
    Predator& p = predators_[k];
    p.until_turn -= dt;
    if (!Inside(box_, p.position, dimensions_)) {
      Vec3d back = box_.Center() - p.position;
      if (dimensions_ == 2) back.z = 0;
      p.heading = Normalized(back);
    } else if (p.chases) {
      Vec3d way = nearest_animal(p.position) - p.position;
      if (dimensions_ == 2) way.z = 0;
      if (SquaredNorm(way) > 0) p.heading = Normalized(way);
    } else if (p.until_turn <= 0) {
      Rng rng = StreamOf(Stream::kPredator, seed_, k, step + 1);
      p.heading = RandomHeading(dimensions_, &rng);
      p.until_turn = p.turn_interval * rng.Uniform(0.5, 1.5);
    }
    p.velocity += std::min(1.0, kTurnRate * dt) * (p.speed * p.heading - p.velocity);
    p.position += dt * p.velocity;
  }
}

}  // namespace flocklift
