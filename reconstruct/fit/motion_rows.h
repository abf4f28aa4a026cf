// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From an observed flock to accelerations and terms. A second difference over 2m frames is the
// acceleration averaged under a triangle, exactly, be it over time or over an engine's steps:
//   (x_{k+m} - 2 x_k + x_{k-m}) / (m dt)^2 = sum_{|j| < M} (M - |j|) / M^2 a(k + j / S),  M = m S
// with S steps a frame. So the terms are averaged alike, at states between the frames, and neither
// a wide window nor the hard edge of a neighbourhood costs a bias:
//   y_k = sum_p theta_p X_kp + known_k + c n_k + u_k
//   X_kp = sum_{|j| < M} (M - |j|) / M^2 f_p(state(k + j / S)), and likewise known and n
// Position noise of sd sigma is sqrt(6) sigma / (m dt)^2 of u. All this sees frames k - m - 1 ..
// k + m + 1. Besides, the terms of the state at frame k as foreseen (observed_flock.h) from frames
// up to k - m - 2: Z_kp; and up to k - 2m - 2, outside what y_{k-m} and X_{k-m} see too: Z'_kp.
//
// Where the model's speed clamp acts, dv is perpendicular to v, and so are the terms then made; a
// window is used when the clamp acted throughout it or not at all.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_MOTION_ROWS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_MOTION_ROWS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "reconstruct/fit/flock_terms.h"
#include "reconstruct/fit/observed_flock.h"
#include "simulate/core/progress.h"

namespace flocklift {

struct MotionOptions {
  int window = 1;              // m [frames]
  int substeps = 4;            // S; 0: continuous time, sampled four times a frame
  double clamp_margin = 0.01;  // relative distance to a speed limit within which it acts
  int threads = 1;
};

// One row an animal and frame, by frame, then animal; all vectors in the world frame.
struct MotionRows {
  std::size_t terms = 0;  // p
  int window = 1;
  std::vector<int> frame, animal;
  std::vector<Vec3d> position;    // R [m]
  std::vector<Vec3d> response;    // R: y [m/s^2]
  std::vector<Vec3d> known;       // R [m/s^2]
  std::vector<Vec3d> near_known;  // R: of the same foreseen state as Z
  std::vector<Vec3d> features;    // R x (p + 1): X, then n
  std::vector<Vec3d> near;        // R x (p + 1): Z, then n of the same foreseen state
  std::vector<Vec3d> far;         // R x (p + 1): Z', likewise
  std::vector<double> depth_sd;   // R [m]
  std::vector<bool> clamped;      // R: the clamp acted throughout
  std::int64_t mixed = 0;         // left out: the clamp acted in part of the window

  std::size_t size() const { return frame.size(); }
  // Row of an animal in a frame, or -1.
  std::int64_t Find(int wanted_frame, int wanted_animal) const;

  // The rows whose windows lie before frame `split`, or from it on.
  MotionRows Before(int split) const;
  MotionRows From(int split) const;
  // All rows without the terms marked.
  MotionRows WithoutTerms(const std::vector<bool>& drop) const;

 private:
  template <typename Keep>
  MotionRows Subset(const Keep& keep) const;
};

// Rows of the middle frames asked for (increasing), as far as the tracks have them.
MotionRows BuildMotionRows(const MotionOptions& options, const FlockTerms& terms,
                           const ObservedFlock& flock, std::span<const int> middles,
                           const Progress& progress = {});

// Mean square of second differences over m frames, per component [m^2]; NaN without any.
double SecondDifferenceMeanSquare(const ObservedFlock& flock, int window);

// The shortest window whose second differences are mostly motion. Doubling it multiplies their mean
// square by 16 for smooth motion, by 8 for a velocity that diffuses, less where motion forgets
// itself within it, and by 1 for position noise alone: the factor grows with the window as long as
// noise matters. At most `longest` [s], and as the tracks allow. At least 1.
int ChooseWindow(const ObservedFlock& flock, double longest);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_MOTION_ROWS_H_
