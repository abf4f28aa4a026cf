// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Kalman filter of one animal in the image: its position, velocity and, with Singer's model, its
// acceleration (motion_step.h). Both axes have the same noise, hence one covariance
// P = [pp pv pa; pv vv va; pa va aa] for both. Over some frames
//   x <- F x,   P <- F P F' + q Q,
// and a measured position z of variance r per axis gives
//   K = P [1 0 0]' / (pp + r),   x <- x + K (z - position),   P <- P - K [pp pv pa].
// Bar-Shalom, Li, Kirubarajan, "Estimation with applications to tracking and navigation", 2001.

#ifndef FLOCKLIFT_TRACK_PREDICT_KALMAN_H_
#define FLOCKLIFT_TRACK_PREDICT_KALMAN_H_

#include "simulate/core/vec3.h"
#include "track/predict/motion_step.h"

namespace flocklift {

struct MotionState {
  Vec2d position;                 // [px]
  Vec2d velocity;                 // [px/frame]
  double pp = 0, pv = 0, vv = 0;  // covariance [px^2, px^2/frame, px^2/frame^2]
  Vec2d acceleration = {};        // [px/frame^2]
  double pa = 0, va = 0, aa = 0;  // its covariances [px^2/frame^2, px^2/frame^3, px^2/frame^4]
};

// `q` is in px^2/frame^3.
inline void Predict(MotionState* s, const MotionStep& step, double q) {
  const double t = step.frames, a = step.f_pa, b = step.f_va, c = step.f_aa;
  s->position.x += t * s->velocity.x + a * s->acceleration.x;
  s->position.y += t * s->velocity.y + a * s->acceleration.y;
  s->velocity.x += b * s->acceleration.x;
  s->velocity.y += b * s->acceleration.y;
  s->acceleration.x *= c;
  s->acceleration.y *= c;
  // F P, column by column, then (F P) F'.
  const double pa = s->pa + t * s->va + a * s->aa, va = s->va + b * s->aa;
  const double pv = s->pv + t * s->vv + a * s->va;
  s->pp += t * (2 * s->pv + t * s->vv) + a * (s->pa + t * s->va + pa) + q * step.q_pp;
  s->pv = pv + b * pa + q * step.q_pv;
  s->vv += b * (s->va + va) + q * step.q_vv;
  s->pa = c * pa + q * step.q_pa;
  s->va = c * va + q * step.q_va;
  s->aa = c * c * s->aa + q * step.q_aa;
}

// With constant velocity.
inline void Predict(MotionState* s, double q, double frames = 1) {
  Predict(s, StepOf(0, frames), q);
}

inline void Update(MotionState* s, const Vec2d& z, double r) {
  const double innovation_variance = s->pp + r;
  const double kp = s->pp / innovation_variance, kv = s->pv / innovation_variance;
  const double ka = s->pa / innovation_variance;
  const double dx = z.x - s->position.x, dy = z.y - s->position.y;
  s->position.x += kp * dx;
  s->position.y += kp * dy;
  s->velocity.x += kv * dx;
  s->velocity.y += kv * dy;
  s->acceleration.x += ka * dx;
  s->acceleration.y += ka * dy;
  s->vv -= kv * s->pv;
  s->va -= kv * s->pa;
  s->aa -= ka * s->pa;
  s->pv *= 1 - kp;
  s->pa *= 1 - kp;
  s->pp *= 1 - kp;
}

// Squared Mahalanobis distance of z from the predicted measurement (2 degrees of freedom).
inline double SquaredInnovation(const MotionState& s, const Vec2d& z, double r) {
  const double dx = z.x - s.position.x, dy = z.y - s.position.y;
  return (dx * dx + dy * dy) / (s.pp + r);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_PREDICT_KALMAN_H_
