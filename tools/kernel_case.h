// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Flocks of known kernels, by a loop of their own (Runge and Kutta's fourth order; Euler and
// Maruyama where noise drives), to try fits of kernels on. The settings of the learning literature
// are those of Lu, Zhong, Tang and Maggioni, PNAS 116 (2019), 14424, and of the definitions that
// they published with it (github.com/mingjzhong/LearningDynamics), f_i divided by N there:
//   lennard-jones  d 2, N 7, phi = 24 e / s^2 (-2 (s/r)^14 + (s/r)^8), e = 10, s = 1, constant
//                  below r = s; x ~ N(0, 1); 1000 runs, 101 times in [0, 0.01], predicted to 0.5
//   opinion        d 1, N 10, phi 1 up to 1/sqrt(2), then 0.1 up to 1, both edges rounded by a
//                  cosine over +- 0.05; x uniform in [0, 10]; 50 runs, 200 times in [0, 15],
//                  predicted to 30
//   opinion-steps  the same with its edges sharp
// and of our own, of second order:
//   flock          d 3, N 15, phi_E attracts beyond 1 m and repels within, phi_A = 0.4 exp(-r
//   / 1.5);
//                  D = 1e-3; 20 runs, 200 times in [0, 4], predicted (without noise) to 6

#ifndef FLOCKLIFT_TOOLS_KERNEL_CASE_H_
#define FLOCKLIFT_TOOLS_KERNEL_CASE_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "simulate/core/trajectory.h"
#include "simulate/core/vec3.h"

namespace flocklift {

using DistanceKernel = std::function<double(double)>;

struct KernelSystem {
  std::string name;
  int order = 1, dimensions = 2, animals = 7;
  DistanceKernel attraction, alignment;  // of the plain sum over the others
  double diffusion = 0;                  // D
  double spread = 1;                     // of the start: sd, or side of a box where `is_box`
  bool is_box = false;
  double speed = 0;     // sd of the start's velocities
  double seen_end = 1;  // [s]: frames lie evenly in [0, seen_end]
  double last_end = 2;  // [s]: predicted until then
  int frames = 100;
  int runs = 10;     // that the fit sees
  int substeps = 1;  // steps a frame

  double dt() const { return seen_end / (frames - 1); }
  double fps() const { return 1 / dt(); }
};

const std::vector<KernelSystem>& KernelSystems();

struct KernelState {
  std::vector<Vec3d> x, v;
};

KernelState StartOf(const KernelSystem& system, std::uint64_t seed, int run);

// States at 0, dt, .. up to frame `frames - 1`. `seed` matters with diffusion only.
std::vector<KernelState> Fly(const KernelSystem& system, const KernelState& start, int frames,
                             std::uint64_t seed, int run);

// As seen: frames from 1, each coordinate in use with position noise of this sd.
Trajectories Seen(const KernelSystem& system, const std::vector<KernelState>& states, double noise,
                  std::uint64_t seed, int run);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_KERNEL_CASE_H_
