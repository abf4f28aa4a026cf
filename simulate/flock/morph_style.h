// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The velocity V_l that gives a flock that morphs (simulate/flock/flock_morph.h) its style, besides
// that of the path: curl noise where each tetrahedron is, a wind with turbulence, or gravity.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MORPH_STYLE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MORPH_STYLE_H_

#include <cstdint>

#include "simulate/core/vec3.h"
#include "simulate/flock/morph_options.h"

namespace flocklift {

// The time now, as all tetrahedra have it.
struct MorphMoment {
  std::uint64_t seed;
  std::uint32_t step;
  double dt, time;  // [s]
};

// omega2 V_l of the wind for the tetrahedron of a rank: turbulence as an Ornstein-Uhlenbeck process
// of its own. `before` is that of the last step, 0 at the first [m/s].
Vec3d WindStyle(const MorphOptions& options, const MorphMoment& now, std::uint64_t rank,
                const Vec3d& before, bool first);

// omega2 V_l of gravity for one that left so long ago [s].
Vec3d GravityStyle(const MorphOptions& options, double age);

// omega2 V_l of the curl noise for first .. last - 1, first a multiple of 16; columns are padded
// and may be written there.
void CurlStyle(const MorphOptions& options, std::uint64_t seed, const float* x, const float* y,
               const float* z, std::uint32_t first, std::uint32_t last, float* vx, float* vy,
               float* vz);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MORPH_STYLE_H_
