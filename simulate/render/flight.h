// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From trajectories to animals in flight: which way each body points. The pose of the file where
// it has one; otherwise nose along the velocity and banked as in a coordinated turn, where the lift
// along body z carries weight and acceleration: body z ~ a - g across the heading. However hard it
// dives, a body keeps at least a third of its weight on the wings, so none flies upside down.

#ifndef FLOCKLIFT_SIMULATE_RENDER_FLIGHT_H_
#define FLOCKLIFT_SIMULATE_RENDER_FLIGHT_H_

#include <functional>
#include <span>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/animal.h"
#include "simulate/core/trajectory.h"
#include "simulate/render/body.h"

namespace flocklift {

// world_from_body of a coordinated turn. `up` is the unit vector against gravity. A body without
// lift, or with lift along its heading, flies with its wings level.
Rotation3d WorldFromBankedBody(const Vec3d& velocity, const Vec3d& acceleration, const Vec3d& up);

// The animals of trajectories, ready to be drawn at any frame.
class Flight {
 public:
  // `animals` gives the bodies by id; whoever is missing there gets the default body. When the
  // camera does not know gravity, up is up in the image. fps must be positive.
  Flight(Trajectories trajectories, std::span<const Animal> animals, const Camera& camera,
         double fps);

  // Who is there in `frame`, by increasing id.
  std::vector<FlyingAnimal> At(int frame) const;
  // ... and where `wanted(position)` holds.
  std::vector<FlyingAnimal> At(int frame, const std::function<bool(const Vec3d&)>& wanted) const;

  FrameSpan span() const { return span_; }
  double TimeOf(int frame) const { return (frame - 1) / fps_; }  // [s]

 private:
  Trajectories trajectories_;
  std::vector<Animal> animal_of_;  // of each trajectory
  Vec3d up_;
  double fps_;
  FrameSpan span_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_FLIGHT_H_
