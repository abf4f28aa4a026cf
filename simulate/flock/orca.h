// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Collision-free velocities: optimal reciprocal collision avoidance in three dimensions, after van
// den Berg, Guy, Lin and Manocha, "Reciprocal n-body collision avoidance", ISRR 2009 (2011).
// Velocities of A relative to B that collide within the horizon tau fill a cone with a round tip:
//   { v : |t v - dx| < r for some t in (0, tau] },   dx = x_B - x_A,   r the sum of the radii.
// With u the shortest way from v_A - v_B to its surface and n the outward normal there, A takes
// half:
//   n . (v - (v_A + u / 2)) >= 0
// Each animal then has the velocity nearest to its preferred one that satisfies the planes of all
// its neighbours and |v| <= max_speed; where there is none, the one that violates the worst plane
// least.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_ORCA_H_
#define FLOCKLIFT_SIMULATE_FLOCK_ORCA_H_

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/flock/bodies.h"
#include "simulate/flock/cell_grid.h"

namespace flocklift {

// Velocities v with normal . (v - point) >= 0 [m/s]; the normal has length 1.
struct HalfSpace {
  Vec3d point, normal;
};

// What A owes B. `dt` is the step in which a pair that overlaps already is to part.
HalfSpace AvoidPair(const Vec3d& dx, const Vec3d& v_a, const Vec3d& v_b, double radii,
                    double horizon, double dt);

// The velocity of at most max_speed nearest to `preferred` in all half-spaces, or, if there is
// none, with the least greatest violation. `room` saves allocations.
Vec3d NearestVelocity(std::span<const HalfSpace> allowed, const Vec3d& preferred, double max_speed,
                      std::vector<HalfSpace>* room);

// What A owes something that stands still `distance` away [m], from the way out of it (a unit
// vector): not to be nearer than its radius within the horizon.
HalfSpace AvoidWall(const Vec3d& way_out, double distance, double radius, double horizon);

struct OrcaOptions {
  double horizon = 1;        // tau [s]
  double max_speed = 1;      // [m/s]
  double sight = 1;          // others nearer than this are avoided [m]
  int most_neighbours = 16;  // of them, the nearest
};

// Turns preferred velocities into collision-free ones, in the order of `bodies`, which is that of
// the grid, sorted by options.sight at least. radius [m] is by agent. Neighbours are avoided as if
// they kept the velocities they have; add_walls(k, &allowed), if given, adds what else animal k has
// to avoid. The result does not depend on the threads.
using AddWalls = std::function<void(std::size_t k, std::vector<HalfSpace>* allowed)>;
template <typename T>
void AvoidCollisions(const OrcaOptions& options, double dt, const CellGrid<T>& grid,
                     const Bodies<T>& bodies, const std::vector<T>& radius,
                     const AddWalls& add_walls, ThreadPool* pool, std::vector<Vec3<T>>* velocities);

extern template void AvoidCollisions(const OrcaOptions&, double, const CellGrid<float>&,
                                     const Bodies<float>&, const std::vector<float>&,
                                     const AddWalls&, ThreadPool*, std::vector<Vec3<float>>*);
extern template void AvoidCollisions(const OrcaOptions&, double, const CellGrid<double>&,
                                     const Bodies<double>&, const std::vector<double>&,
                                     const AddWalls&, ThreadPool*, std::vector<Vec3<double>>*);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_ORCA_H_
