// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The smooth part of a flock's motion as a state-space estimate needs it:
//   dx_i = v_i dt,   dv_i = a_i(x, v; theta) dt + noise
// with theta any of the model's parameters, radii too, and how an animal's own state changes its
// own acceleration. By the same templated terms that the simulator runs.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_PROCESS_MODEL_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_PROCESS_MODEL_H_

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reconstruct/fit/observed_flock.h"
#include "reconstruct/fit/term_surroundings.h"
#include "simulate/core/scene.h"

namespace flocklift {

// d a_i / d x_i [1/s^2] and d a_i / d v_i [1/s], row-major, the other animals held.
struct OwnSlope {
  std::array<double, 9> position{}, velocity{};

  bool operator==(const OwnSlope&) const = default;
};

struct SpeedRange {
  double low = 0, high = 0;  // [m/s]
};

struct ProcessModel {
  std::vector<std::string> free;  // the p parameters of theta, by their names in the model
  std::vector<double> start;      // p: their values in the model
  // Fills `a` [m/s^2] of the animals at positions x with velocities v and, where `slopes` is not
  // empty, their own slopes. Safe to call from several threads.
  std::function<void(std::span<const double> theta, std::span<const Vec3d> x,
                     std::span<const Vec3d> v, std::span<Vec3d> a, std::span<OwnSlope> slopes)>
      evaluate;
  // The model's clamp, applied after every step; absent: none.
  std::function<SpeedRange(std::span<const double> theta)> speed_range;
};

// The parameters that a state-space estimate of the model can free, none where it is not smooth:
// all of `linear`; of boids whose windows have tapers, whose noise has no memory and which know no
// cruising speeds of their own, the weights, radii, tapers and speed limits; of `forces` and of
// what a scene adds to either likewise (scene_terms.h). InputError for a model that does not exist.
std::vector<std::string> SmoothParameters(const ModelSpec& model);

// `model` gives every value that is not free, `walls` the box of boids' boundary, if any, `around`
// what the terms of a scene feel. Throws InputError for a model that is not smooth and a name that
// is none of its parameters.
ProcessModel MakeProcessModel(const ModelSpec& model, const std::vector<std::string>& free,
                              const std::optional<Region>& walls = {},
                              const TermSurroundings& around = {});

// Per component, how much each parameter changes an acceleration: rms of da / d theta_p over the
// observed flock [m/s^2 per unit]. The differences are small beside `sd`, where it is finite.
std::vector<double> ParameterRms(const ProcessModel& model, const std::vector<double>& theta,
                                 const std::vector<double>& sd, const ObservedFlock& flock,
                                 int substeps);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_PROCESS_MODEL_H_
