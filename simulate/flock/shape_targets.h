// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where each animal of a species belongs on its shape at any time: its own sample of the surface,
// one to one (simulate/shapes/correspondence.h).
//
// An animation (a shape with a period) has one set of samples, which move with the mesh. Shapes one
// after the other have a set each, and an animal's sample passes to one near by on the next. On a
// path the mesh is taken in the path's frame (x along it, z up) and moves along by arc length.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SHAPE_TARGETS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SHAPE_TARGETS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/core/vec3.h"
#include "simulate/flock/world.h"
#include "simulate/shapes/spline_path.h"
#include "simulate/shapes/surface_samples.h"

namespace flocklift {

class ShapeTargets {
 public:
  // `start`: where the animals are at `time` [s]. `path` may be null; without a speed of its own it
  // is flown in `duration` [s]. Samples are relaxed to convergence.
  ShapeTargets(const ShapeInTime& shape, const PathSpec* path, double duration,
               const std::vector<Vec3d>& start, double time, std::uint64_t seed, int threads);

  // By agent. The same vector until something has moved.
  const std::vector<Vec3d>& At(double time, ThreadPool* pool);
  int version() const { return version_; }  // another one after each change of what At returns
  // Of the path's frame at a time [m/s].
  Vec3d Velocity(double time) const;
  double Spacing(double time) const;  // mean distance of the samples sqrt(A/N) [m]

  // The shape as it is, and where it is, at a time.
  TriangleMesh MeshAt(double time) const;

  // Mean distance of points, by agent, to the surface of the shape now: a shape error [m].
  double MeanDistanceToSurface(const std::vector<Vec3d>& points, double time) const;

 private:
  std::size_t ShapeAt(double time) const;

  const ShapeInTime& shape_;
  std::optional<SplinePath> path_;
  double path_speed_ = 0, start_time_ = 0;           // [m/s], [s]
  std::vector<std::vector<SurfaceSample>> samples_;  // of each shape, by agent
  std::vector<double> spacing_;                      // of each shape [m]
  std::vector<Vec3d> target_;
  std::optional<double> target_time_;  // of target_
  int version_ = 0;                    // likewise
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SHAPE_TARGETS_H_
