// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/flight.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kTurnTime = 0.1;  // accelerations are taken over +- this long [s]

}  // namespace

Rotation3d WorldFromBankedBody(const Vec3d& velocity, const Vec3d& acceleration, const Vec3d& up) {
  Vec3d forward = Normalized(velocity);
  if (forward == Vec3d{}) forward = Normalized(Cross(up, Vec3d{0.36, 0.48, 0.8}));
  const double climb = Dot(acceleration, up);
  const Vec3d lift = acceleration + (std::max(climb + kGravity, kGravity / 3) - climb) * up;
  for (const Vec3d& direction : {lift, up, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}) {
    const Vec3d across = direction - Dot(direction, forward) * forward;
    if (Norm(across) < 1e-6) continue;
    const Vec3d z = Normalized(across);
    return Rotation3d::FromRows(forward, Cross(z, forward), z).Inverse();
  }
  return {};
}

Flight::Flight(Trajectories trajectories, std::span<const Animal> animals, const Camera& camera,
               double fps)
    : trajectories_(std::move(trajectories)),
      up_(camera.KnowsGravity() ? Vec3d{0, 0, 1} : Vec3d{0, -1, 0}),
      fps_(fps),
      span_(SpanOf(trajectories_)) {
  Check(fps > 0, "fps must be positive to draw trajectories");
  if (!trajectories_.has_velocity) ComputeVelocities(fps, &trajectories_);
  std::unordered_map<Id, const Animal*> by_id;
  for (const Animal& animal : animals) by_id.emplace(animal.id, &animal);
  for (const Trajectory& trajectory : trajectories_.trajectories) {
    const auto found = by_id.find(trajectory.id);
    Animal animal = found != by_id.end() ? *found->second : Animal{};
    animal.id = trajectory.id;
    animal_of_.push_back(animal);
  }
}

std::vector<FlyingAnimal> Flight::At(int frame) const {
  return At(frame, [](const Vec3d&) { return true; });
}

std::vector<FlyingAnimal> Flight::At(int frame,
                                     const std::function<bool(const Vec3d&)>& wanted) const {
  std::vector<FlyingAnimal> flying;
  const int reach = std::max(1, static_cast<int>(std::lround(kTurnTime * fps_)));
  for (std::size_t k = 0; k < trajectories_.trajectories.size(); ++k) {
    const auto& points = trajectories_.trajectories[k].points;
    const auto now =
        std::lower_bound(points.begin(), points.end(), frame,
                         [](const TrajectoryPoint& p, int wanted) { return p.frame < wanted; });
    if (now == points.end() || now->frame != frame || !wanted(now->position)) continue;
    FlyingAnimal& bird = flying.emplace_back();
    bird.animal = animal_of_[k];
    bird.position = now->position;
    bird.velocity = now->velocity;
    if (trajectories_.has_orientation) {
      bird.world_from_body = RotationFromQuaternion(now->world_from_body);
      continue;
    }
    auto before = now, after = now;
    while (before != points.begin() && std::prev(before)->frame >= frame - reach) --before;
    while (std::next(after) != points.end() && std::next(after)->frame <= frame + reach) ++after;
    const int frames = after->frame - before->frame;
    const Vec3d acceleration =
        frames > 0 ? (after->velocity - before->velocity) * (fps_ / frames) : Vec3d{};
    bird.world_from_body = WorldFromBankedBody(bird.velocity, acceleration, up_);
  }
  return flying;
}

}  // namespace flocklift
