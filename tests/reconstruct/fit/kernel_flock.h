// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Small flocks that kernels of distance drive, by a loop of its own.

#ifndef FLOCKLIFT_TESTS_RECONSTRUCT_FIT_KERNEL_FLOCK_H_
#define FLOCKLIFT_TESTS_RECONSTRUCT_FIT_KERNEL_FLOCK_H_

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct KernelFlock {
  int order = 1, animals = 6, dimensions = 3, frames = 60, substeps = 20;
  double dt = 0.05, spread = 1, speed = 0.5;
  std::function<double(double)> attraction, alignment;
  double diffusion = 0, noise = 0;
  double drift = 0;  // sd of what drives each animal besides, the same all the time
};

// Animals 1 .. N in frames 1 .. F.
inline Trajectories FlyKernels(const KernelFlock& flock, std::uint64_t seed) {
  const auto n = static_cast<std::size_t>(flock.animals);
  Rng rng(seed, 77);
  const auto normal = [&] {
    Vec3d v;
    v.x = rng.Normal();
    if (flock.dimensions > 1) v.y = rng.Normal();
    if (flock.dimensions > 2) v.z = rng.Normal();
    return v;
  };
  std::vector<Vec3d> x(n), v(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = flock.spread * normal();
    v[i] = flock.speed * normal();
  }
  std::vector<Vec3d> push(n);
  if (flock.drift > 0) {
    for (Vec3d& own : push) own = flock.drift * normal();
  }
  const auto drive = [&](const std::vector<Vec3d>& at, const std::vector<Vec3d>& going) {
    std::vector<Vec3d> f = push;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (j == i) continue;
        const double r = Norm(at[j] - at[i]);
        f[i] += flock.attraction(r) * (at[j] - at[i]);
        if (flock.alignment) f[i] += flock.alignment(r) * (going[j] - going[i]);
      }
    }
    return f;
  };
  const auto along = [&](const std::vector<Vec3d>& a, const std::vector<Vec3d>& b, double h) {
    std::vector<Vec3d> sum = a;
    for (std::size_t i = 0; i < n; ++i) sum[i] += h * b[i];
    return sum;
  };
  Trajectories seen;
  seen.fps = 1 / flock.dt;
  for (int i = 0; i < flock.animals; ++i) seen.trajectories.push_back({.id = i + 1, .points = {}});
  const double h = flock.dt / flock.substeps, kick = std::sqrt(2 * flock.diffusion * h);
  for (int frame = 1; frame <= flock.frames; ++frame) {
    for (std::size_t i = 0; i < n; ++i) {
      TrajectoryPoint point;
      point.frame = frame;
      point.position = x[i];
      if (flock.noise > 0) point.position += flock.noise * normal();
      seen.trajectories[i].points.push_back(point);
    }
    for (int step = 0; step < flock.substeps; ++step) {  // the midpoint rule
      if (flock.order == 1) {
        x = along(x, drive(along(x, drive(x, v), h / 2), v), h);
      } else {
        const std::vector<Vec3d> half = along(v, drive(x, v), h / 2);
        const std::vector<Vec3d> a = drive(along(x, v, h / 2), half);
        x = along(x, half, h);
        v = along(v, a, h);
      }
      if (kick == 0) continue;
      for (Vec3d& moved : flock.order == 1 ? x : v) moved += kick * normal();
    }
  }
  return seen;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_RECONSTRUCT_FIT_KERNEL_FLOCK_H_
