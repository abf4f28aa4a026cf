// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the flock does to one of its animals, by the terms of boids that the simulator runs
// (simulate/flock/boids.h), with smooth edges and derivatives. In the axes of the camera:
//   F_i = separation + cohesion + alignment                      (of its neighbours)
//       + cruise (m_i - |v|) v/|v| - level (v . up) up + spring (center - x) + pull(t)
// spring and pull(t), linear between knots, stand for a goal that nobody has told.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_FLOCK_FORCES_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_FLOCK_FORCES_H_

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift::internal {

inline constexpr double kPullKnotTime = 2;  // [s]

struct FlockForces {
  double d_s = 4, d_v = 12;                                                         // [m]
  double alpha_s = 0, alpha_c = 0, alpha_a = 0, cruise = 0, level = 0, spring = 0;  // as in boids
  Vec3d center;                                                                     // [m]
  std::vector<Vec3d> pull;                                                          // [m/s^2]
  std::optional<Vec3d> up_in_cam;

  double Taper() const { return 0.4 * d_s; }  // of both radii [m]
  double Reach() const { return d_v + 0.5 * Taper(); }
  Vec3d PullAt(double time) const;
};

// x_j - x_i and v_j - v_i.
struct Offset {
  Vec3d dx, dv;
};

using Matrix36 = Eigen::Matrix<double, 3, 6>;

// The force of neighbours; with `derivatives` (one for each offset), those by (dx, dv).
Vec3d PairForce(const FlockForces& forces, std::span<const Offset> offsets, Matrix36* derivatives);

// The rest; with `derivative`, that by (x, v).
Vec3d SelfForce(const FlockForces& forces, double cruising_speed, double time, const Vec3d& x,
                const Vec3d& v, Matrix36* derivative);

// Separation, cohesion and alignment with unit gains, then cruise, level and spring with unit
// gains: what the force is linear in.
inline constexpr int kForceGains = 6;
std::array<Vec3d, kForceGains> UnitForces(const FlockForces& forces, double cruising_speed,
                                          std::span<const Offset> offsets, const Vec3d& x,
                                          const Vec3d& v);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_FLOCK_FORCES_H_
