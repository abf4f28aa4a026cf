// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Kalman filter of one animal in the image: constant velocity, white acceleration of power q. Both
// axes have the same noise, hence one covariance P = [pp pv; pv vv] for both. Over t frames
//   x <- x + t v,   P <- F P F' + q [t^3/3 t^2/2; t^2/2 t],   F = [1 t; 0 1],
// and a measured position z of variance r per axis gives
//   K = P [1 0]' / (pp + r),   (x, v) <- (x, v) + K (z - x),   P <- P - K [pp pv].
// Bar-Shalom, Li, Kirubarajan, "Estimation with applications to tracking and navigation", 2001.

#ifndef FLOCKLIFT_TRACK_PREDICT_KALMAN_H_
#define FLOCKLIFT_TRACK_PREDICT_KALMAN_H_

#include "simulate/core/vec3.h"

namespace flocklift {

struct MotionState {
  Vec2d position;                 // [px]
  Vec2d velocity;                 // [px/frame]
  double pp = 0, pv = 0, vv = 0;  // covariance [px^2, px^2/frame, px^2/frame^2]
};

// `q` is in px^2/frame^3.
inline void Predict(MotionState* s, double q, double frames = 1) {
  const double t = frames;
  s->position.x += t * s->velocity.x;
  s->position.y += t * s->velocity.y;
  s->pp += t * (2 * s->pv + t * s->vv) + q * t * t * t / 3;
  s->pv += t * s->vv + q * t * t / 2;
  s->vv += q * t;
}

inline void Update(MotionState* s, const Vec2d& z, double r) {
  const double innovation_variance = s->pp + r;
  const double kp = s->pp / innovation_variance, kv = s->pv / innovation_variance;
  const double dx = z.x - s->position.x, dy = z.y - s->position.y;
  s->position.x += kp * dx;
  s->position.y += kp * dy;
  s->velocity.x += kv * dx;
  s->velocity.y += kv * dy;
  s->vv -= kv * s->pv;
  s->pv *= 1 - kp;
  s->pp *= 1 - kp;
}

// Squared Mahalanobis distance of z from the predicted measurement (2 degrees of freedom).
inline double SquaredInnovation(const MotionState& s, const Vec2d& z, double r) {
  const double dx = z.x - s.position.x, dy = z.y - s.position.y;
  return (dx * dx + dy * dy) / (s.pp + r);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_PREDICT_KALMAN_H_
