// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/batch_model.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/cost_functions/erratic_flight.h"
#include "reconstruct/cost_functions/size.h"
#include "reconstruct/initialize/persistence.h"

namespace flocklift::internal {
namespace {

// A prior that says next to nothing, of a logarithm.
constexpr double kVague = 3;
// Second moments of a silhouette weigh body and wings by area and vary more than boxes.
constexpr Uncertain kTrunkOfBoxes{kUsualLogTrunk, 0.4}, kUpOfBoxes{kUsualLogUp, 0.7};
constexpr Uncertain kTrunkOfShapes{-1.2, 0.6}, kUpOfShapes{-1.6, 0.7};
// Log of (root mean square of a box's diagonal over all views, over the wingspan), until headings
// are known well enough for box_of_body.h: 0 to -0.1 gliding (the extents above add up to 5/6 of
// the span), -0.2 and less beating; blur adds a little.
constexpr Uncertain kRatio{-0.2, 0.15};
// How far they lean into their turns: 1 where lift alone carries weight and curve, 0 not at all.
constexpr Uncertain kLeanIntoTurns{0.7, 0.5};

// Velocities and accelerations last as long as the image says; where wings and trunk point is not
// to be told from them, and images count as those of balls.
void MakeErratic(double persistence, BatchModel* model) {
  constexpr double kLeast = 0.05;
  constexpr Uncertain kBall{0, 0.1};  // of logs of proportions
  const double time = -kPersistenceLag / std::log(std::max(persistence, kLeast));
  Spreads& s = model->spreads;
  model->erratic = true;
  model->up_in_cam.reset();
  model->use_climb = false;
  model->log_trunk = model->log_up = kBall;
  s.speed = {kLogAcrossSd, std::min(s.speed.time, time)};
  s.along = {kAlongSd, s.speed.time};
  s.acceleration.time = std::min(s.acceleration.time, time);
}

}  // namespace

BatchModel MakeModel(const BatchOptions& options, const Knowledge& knowledge,
                     const Segments& segments, const ScaleGuess& guess,
                     const std::optional<Belief>& belief, double fps) {
  BatchModel model;
  model.knot_interval = std::max(options.knot_interval, 1 / fps);
  model.camera = CameraPath(segments.camera_places, fps, model.knot_interval);
  Spreads& s = model.spreads;
  s.acceleration = {options.acceleration_sd, options.acceleration_time};
  if (options.estimate && guess.image_acceleration > 0) {
    s.acceleration.sd = std::max(0.3 * options.acceleration_sd,
                                 guess.image_acceleration * std::exp(guess.log_depth));
  }
  s.turn = {0.7 * s.acceleration.sd, kTurnKnotTime};
  s.speed = {options.speed_sd, options.speed_time};
  s.size = {options.size_sd, options.size_time};
  s.climb = {options.climb_sd, options.climb_time};
  s.depth = {std::max(guess.lateral_spread, 0.02), options.depth_time};
  s.speed_between = options.speed_spread;
  s.size_between =
      knowledge.wingspan ? std::max(0.01, knowledge.wingspan->sd / knowledge.wingspan->mean) : 0.07;
  model.log_wingspan = knowledge.wingspan ? std::log(knowledge.wingspan->mean) : 0;
  model.up_in_cam = knowledge.up_in_cam;
  model.use_climb = options.level_flight && knowledge.up_in_cam.has_value();
  model.use_depth = options.shared_depth;
  model.use_size = knowledge.use_size;
  if (knowledge.near) model.log_near = std::log(*knowledge.near);
  if (knowledge.far) model.log_far = std::log(*knowledge.far);
  model.flock_log_speed = {guess.log_speed,
                           knowledge.speed ? knowledge.speed->sd / knowledge.speed->mean : kVague};
  model.size_ratio =
      knowledge.wingspan
          ? Uncertain{kRatio.mean, std::hypot(options.size_ratio_sd, kRatio.sd, s.size_between)}
          : Uncertain{guess.log_width, kVague};
  model.log_trunk = segments.has_shapes ? kTrunkOfShapes : kTrunkOfBoxes;
  model.log_up = segments.has_shapes ? kUpOfShapes : kUpOfBoxes;
  model.lean = kLeanIntoTurns;
  if (options.erratic_flight && IsErratic(segments.persistence)) {
    MakeErratic(segments.persistence, &model);
  }
  model.log_depth = {guess.log_depth, kVague};
  if (knowledge.near && knowledge.far) {
    // Anywhere between them: the sd of a uniform distribution.
    model.log_depth.sd = std::log(*knowledge.far / *knowledge.near) / std::sqrt(12.0);
    model.use_depth = true;
  }
  if (belief) {
    // The scale is another part's; here it is only shared.
    model.belief = belief;
    model.body = belief->body;
    model.flock_log_speed.mean = belief->mean[kFlockLogSpeed];
    model.size_ratio.mean = belief->mean[kSizeRatio];
    model.log_trunk.mean = belief->mean[kLogTrunk];
    model.log_up.mean = belief->mean[kLogUp];
    model.lean.mean = belief->mean[kLean];
    model.log_depth.sd = kVague;
  }
  double last_time = 0;
  for (const Segment& segment : segments.segments) {
    last_time = std::max(last_time, segment.sightings.back().time);
  }
  model.depth = FlockCurve::Until(last_time, kFlockScalars, 1, kDepthKnotTime);
  model.turn = {.first = model.depth.end()};
  if (options.flock_turn) {
    model.turn = FlockCurve::Until(last_time, model.depth.end(), 3, kTurnKnotTime);
  }
  return model;
}

ScaleGuess WithBelief(const ScaleGuess& guess, const Knowledge& knowledge,
                      const std::optional<Belief>& belief) {
  if (!belief) return guess;
  ScaleGuess shifted = guess;
  const double shift = belief->mean[kFlockLogSpeed] - guess.log_speed;
  shifted.log_speed += shift;
  shifted.log_depth += shift;
  shifted.log_width += shift;
  if (!knowledge.near) shifted.log_near += shift;
  if (!knowledge.far) shifted.log_far += shift;
  if (shifted.log_far < shifted.log_near + 0.05) return guess;
  shifted.log_depth = std::clamp(shifted.log_depth, shifted.log_near, shifted.log_far);
  return shifted;
}

Eigen::VectorXd StartOfShared(const BatchModel& model) {
  Eigen::VectorXd shared(model.shared());
  shared[kFlockLogSpeed] = model.flock_log_speed.mean;
  shared[kSizeRatio] = model.size_ratio.mean;
  shared[kLogTrunk] = model.log_trunk.mean;
  shared[kLogUp] = model.log_up.mean;
  shared[kLean] = model.lean.mean;
  shared.tail(model.shared() - kFlockScalars).setZero();
  shared.segment(model.depth.first, model.depth.size()).setConstant(model.log_depth.mean);
  return shared;
}

}  // namespace flocklift::internal
