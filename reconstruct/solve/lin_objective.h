// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of Lin's objective of one frame (cobyla.h), templated on the scalar: COBYLA asks for
// their values alone, Ceres for their derivatives too.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_LIN_OBJECTIVE_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_LIN_OBJECTIVE_H_

#include <cmath>
#include <vector>

#include "reconstruct/solve/cobyla.h"
#include "simulate/forces/lin.h"

namespace flocklift::internal {

// |p - last| - expected, p = depth ray: how much farther than expected an animal came [m].
struct LinStepError {
  Vec3d ray, last;
  double expected = 0;

  template <typename T>
  bool operator()(const T* depth, T* error) const {
    using std::sqrt;
    const Vec3<T> step{depth[0] * ray.x - last.x, depth[0] * ray.y - last.y,
                       depth[0] * ray.z - last.z};
    error[0] = sqrt(Dot(step, step) + T(1e-12)) - expected;
    return true;
  }
};

// Where the rules want animal n, which was at `last`, with everybody at `positions`.
template <typename T>
Vec3<T> LinTargetOf(const CobylaOptions& options, const std::vector<Vec3<T>>& positions,
                    std::size_t n, const Vec3d& last) {
  const typename LinSeparation::Params<T> separation{T(options.d_sep),
                                                     T(options.separation_exponent), T(0.0)};
  const typename LinCohesion::Params<T> cohesion;
  Weighted<T> apart, together;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (i == n) continue;
    const Vec3<T> dx = positions[i] - positions[n];
    apart += LinSeparation::Pair(separation, dx, Vec3<T>{});
    together += LinCohesion::Pair(cohesion, dx, Vec3<T>{});
  }
  return LinTarget(Vec3<T>{T(last.x), T(last.y), T(last.z)}, T(options.lambda_sep),
                   LinSeparation::Finish(separation, apart),
                   LinCohesion::Finish(cohesion, together));
}

// p_n - target_n with the neighbours of frame f-1: a target that stands still [m].
struct LinTargetError {
  Vec3d ray, target;

  template <typename T>
  bool operator()(const T* depth, T* error) const {
    error[0] = depth[0] * ray.x - target.x;
    error[1] = depth[0] * ray.y - target.y;
    error[2] = depth[0] * ray.z - target.z;
    return true;
  }
};

// The same with the neighbours of frame f. `depths`: one pointer for each animal.
struct LinMovingTargetError {
  const CobylaOptions* options = nullptr;
  const std::vector<LinAnimal>* animals = nullptr;
  std::size_t n = 0;

  template <typename T>
  bool operator()(T const* const* depths, T* error) const {
    std::vector<Vec3<T>> positions;
    for (std::size_t i = 0; i < animals->size(); ++i) {
      const Vec3d& ray = (*animals)[i].ray;
      positions.push_back({depths[i][0] * ray.x, depths[i][0] * ray.y, depths[i][0] * ray.z});
    }
    const Vec3<T> off = positions[n] - LinTargetOf(*options, positions, n, (*animals)[n].last);
    error[0] = off.x;
    error[1] = off.y;
    error[2] = off.z;
    return true;
  }
};

// Targets with the neighbours of frame f-1.
std::vector<Vec3d> LinTargetsOfLastFrame(const CobylaOptions& options,
                                         const std::vector<LinAnimal>& animals);

// Minimises the frame's objective from `depths`. Returns its value there; *exhausted says whether
// the optimiser was stopped before it was done.
double MinimizeLinByCobyla(const CobylaOptions& options, double fps,
                           const std::vector<LinAnimal>& animals, std::vector<double>* depths,
                           bool* exhausted);
double MinimizeLinByCeres(const CobylaOptions& options, double fps,
                          const std::vector<LinAnimal>& animals, std::vector<double>* depths,
                          bool* exhausted);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_LIN_OBJECTIVE_H_
