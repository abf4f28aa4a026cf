// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The two parts of a swarm's velocity for one animal (simulate/flock/kernels/swarm_kernel.h does
// many at once): noise where it is, and the guide's velocity and wall distance.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SWARM_VELOCITY_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SWARM_VELOCITY_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "simulate/fields/curl_noise.h"
#include "simulate/flock/kernels/swarm_kernel.h"

namespace flocklift {

template <typename T>
struct GuideSample {
  Vec3<T> velocity;  // [m/s]
  T distance;        // to the nearest wall, at most the guide's reach [m]
};

template <typename T>
Vec3<T> SwarmNoiseVelocity(const SwarmJob& job, int which, const Vec3<T>& x) {
  const SwarmNoise& noise = job.noise[which];
  const NoiseTerm<T> term{T(noise.gain), T(noise.scale), noise.seed};
  return job.curl ? CurlNoise(term, x) : PerlinVelocity(term, x);
}

// Where a point is among a guide's cells: which one, and how far along it.
template <typename T>
struct GuidePlace {
  std::size_t cell;
  T along_x, along_y, along_z;  // in [0, 1]
};

template <typename T>
GuidePlace<T> PlaceInGuide(const SwarmGuide& guide, const Vec3<T>& x) {
  struct Place {
    std::size_t cell;
    T share;
  };
  const auto place = [&guide](T at, float low, int cells) -> Place {
    const T u =
        std::min(std::max(T(0), (at - T(low)) * T(guide.per_spacing)), static_cast<T>(cells));
    const T cell = std::min(std::floor(u), static_cast<T>(cells - 1));
    return {static_cast<std::size_t>(cell), u - cell};
  };
  const Place a = place(x.x, guide.low_x, guide.nx), b = place(x.y, guide.low_y, guide.ny),
              c = place(x.z, guide.low_z, guide.nz);
  const auto nx = static_cast<std::size_t>(guide.nx), ny = static_cast<std::size_t>(guide.ny);
  return {(c.cell * ny + b.cell) * nx + a.cell, a.share, b.share, c.share};
}

// Trilinear: along z, then y, then x.
template <typename T>
GuideSample<T> SampleGuide(const SwarmGuide& guide, const Vec3<T>& x) {
  const GuidePlace<T> at = PlaceInGuide(guide, x);
  const std::int8_t* const corners = guide.cells + kGuideCellBytes * at.cell;
  const auto lerp = [](T from, T to, T share) { return from + share * (to - from); };
  T found[4];
  for (std::size_t n = 0; n < 4; ++n) {
    const auto along_zy = [&](const std::int8_t* from) {
      const auto along_z = [&](const std::int8_t* p) {
        return lerp(T(p[n]), T(p[n + 16]), at.along_z);
      };
      return lerp(along_z(from), along_z(from + 8), at.along_y);
    };
    found[n] = lerp(along_zy(corners), along_zy(corners + 4), at.along_x);
  }
  const T speed = T(guide.speed) / T(127), reach = T(guide.reach) / T(127);
  return {{found[0] * speed, found[1] * speed, found[2] * speed}, found[3] * reach};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SWARM_VELOCITY_H_
