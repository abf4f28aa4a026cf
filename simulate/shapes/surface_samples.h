// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points spread evenly over a surface (equations.md, section 6), held as (triangle, barycentric) so
// that they move with an animated mesh.
//
// First stratified by area, after Alexa, Rusinkiewicz, Nehab, Shilane 2004: the surface is cut into
// N pieces of equal area, one random point in each. Then relaxed by the shape force of Chen et al.
// 2019, eq. 5, as a force that pushes apart along the surface:
//   F_i = (1/N_i) sum_j (s_i - s_j) / |s_i - s_j| exp(-M_ij^2 / (2 sigma^2)),  M_ij < k sqrt(A/N)
// M is the Manhattan distance, sigma = omega sqrt(A/N), A the area; the points are moved along F,
// in the surface. F jumps where neighbours come and go, so the steps shrink, that the points come
// to rest: the step of round r is step / (1 + r / 20). (Not shrunk, the anisotropy of the Manhattan
// distance slowly crowds them where the surface lies askew to the axes.)

#ifndef FLOCKLIFT_SIMULATE_SHAPES_SURFACE_SAMPLES_H_
#define FLOCKLIFT_SIMULATE_SHAPES_SURFACE_SAMPLES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "simulate/core/options.h"
#include "simulate/core/triangle_mesh.h"

namespace flocklift {

// The point (1 - u - v) a + u b + v c of triangle (a, b, c); u, v, 1 - u - v >= 0.
struct SurfaceSample {
  std::uint32_t triangle = 0;
  double u = 0, v = 0;

  friend bool operator==(const SurfaceSample&, const SurfaceSample&) = default;
};

inline Vec3d SamplePoint(const std::vector<Vec3d>& vertices,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles,
                         const SurfaceSample& s) {
  const auto& [a, b, c] = triangles[s.triangle];
  return (1 - s.u - s.v) * vertices[a] + s.u * vertices[b] + s.v * vertices[c];
}

double SurfaceArea(const TriangleMesh& mesh);  // [m^2]

// `count` points, exactly. Throws std::invalid_argument when the mesh has no area.
std::vector<SurfaceSample> StratifiedSamples(const TriangleMesh& mesh, int count,
                                             std::uint64_t seed);

struct RelaxOptions {
  double k = 2;              // neighbours are nearer than k sqrt(A/N)
  double omega = 0.9;        // sigma = omega sqrt(A/N)
  double step = 0.5;         // a point moves step sqrt(A/N) F in the first rounds
  double tolerance = 0.001;  // converged when the mean move is below this share of sqrt(A/N)
  int max_rounds = 300;
  int threads = 1;  // 0: all that the machine has
};

template <typename Visitor>
void Describe(Visitor& visit, RelaxOptions& o) {
  visit("k", o.k, {.low = 0}, "", "neighbours are nearer than k times the mean spacing");
  visit("omega", o.omega, {.low = 1e-6}, "", "fall-off of the push, in mean spacings");
  visit("step", o.step, {.low = 0}, "", "way along the force a round, in mean spacings");
  visit("tolerance", o.tolerance, {.low = 0}, "", "converged below this mean move, in spacings");
  visit("max-rounds", o.max_rounds, {.low = 0}, "", "rounds at most");
  visit("threads", o.threads, {.low = 0}, "", "threads; 0: all that the machine has");
}

struct RelaxReport {
  int rounds = 0;
  double mean_move = 0;  // of the last round, in sqrt(A/N)
  bool converged = false;
};

// Spreads the samples out. The same at any number of threads.
RelaxReport RelaxSamples(const TriangleMesh& mesh, const RelaxOptions& options,
                         std::vector<SurfaceSample>* samples);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_SURFACE_SAMPLES_H_
