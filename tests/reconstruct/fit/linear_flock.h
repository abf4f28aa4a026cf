// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The reference flock of equations.md 2b, with its true velocities: 20 animals, dt 0.005 s, four
// substeps, x ~ N(0, 1), v ~ N(0, 0.3), 200 frames before the first one kept. By its own loop, not
// by the engine.

#ifndef FLOCKLIFT_TESTS_RECONSTRUCT_FIT_LINEAR_FLOCK_H_
#define FLOCKLIFT_TESTS_RECONSTRUCT_FIT_LINEAR_FLOCK_H_

#include <array>
#include <cmath>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct LinearFlock {
  static constexpr double kCohesion = 0.05, kAlignment = 0.2, kDiffusion = 5e-3;
  static constexpr double kDt = 0.005;

  Trajectories seen;  // positions
  // Least squares of every step's dv on the true states before it: what an estimate from
  // velocities that are known without error would be. cohesion, alignment.
  std::array<double, 2> from_true_velocities{};
};

inline LinearFlock FlyLinearFlock(std::uint64_t seed, int frames = 3000, int animals = 20) {
  constexpr int kSubsteps = 4, kBefore = 200;
  const double h = LinearFlock::kDt / kSubsteps, kick = std::sqrt(2 * LinearFlock::kDiffusion * h);
  const auto n = static_cast<std::size_t>(animals);
  std::vector<Vec3d> x(n), v(n);
  Rng rng(seed, 20);
  const auto normal = [&rng] { return Vec3d{rng.Normal(), rng.Normal(), rng.Normal()}; };
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = normal();
    v[i] = 0.3 * normal();
  }
  LinearFlock flock;
  flock.seen.fps = 1 / LinearFlock::kDt;
  for (std::size_t i = 0; i < n; ++i) {
    flock.seen.trajectories.push_back({.id = static_cast<Id>(i) + 1, .points = {}});
  }
  double xx = 0, xv = 0, vv = 0, xa = 0, va = 0;
  for (int step = 0; step < (kBefore + frames) * kSubsteps; ++step) {
    Vec3d x_sum, v_sum;
    for (std::size_t i = 0; i < n; ++i) {
      x_sum += x[i];
      v_sum += v[i];
    }
    const bool kept = step >= kBefore * kSubsteps;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d to_x = x_sum - static_cast<double>(n) * x[i];
      const Vec3d to_v = v_sum - static_cast<double>(n) * v[i];
      const Vec3d change =
          h * (LinearFlock::kCohesion * to_x + LinearFlock::kAlignment * to_v) + kick * normal();
      if (kept) {
        xx += Dot(to_x, to_x);
        xv += Dot(to_x, to_v);
        vv += Dot(to_v, to_v);
        xa += Dot(to_x, change) / h;
        va += Dot(to_v, change) / h;
      }
      v[i] += change;
    }
    for (std::size_t i = 0; i < n; ++i) x[i] += h * v[i];
    if (!kept || step % kSubsteps != kSubsteps - 1) continue;
    for (std::size_t i = 0; i < n; ++i) {
      TrajectoryPoint point;
      point.frame = (step + 1) / kSubsteps - kBefore;
      point.position = x[i];
      flock.seen.trajectories[i].points.push_back(point);
    }
  }
  const double determinant = xx * vv - xv * xv;
  flock.from_true_velocities = {(vv * xa - xv * va) / determinant,
                                (xx * va - xv * xa) / determinant};
  return flock;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_RECONSTRUCT_FIT_LINEAR_FLOCK_H_
