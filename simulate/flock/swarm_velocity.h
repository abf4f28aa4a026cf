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

// Trilinear: along z, then y, then x.
template <typename T>
GuideSample<T> SampleGuide(const SwarmGuide& guide, const Vec3<T>& x) {
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
  const std::size_t row = static_cast<std::size_t>(guide.nx);
  const std::size_t cell = (c.cell * static_cast<std::size_t>(guide.ny) + b.cell) * row + a.cell;
  const std::int8_t* const corners = guide.cells + kGuideCellBytes * cell;
  const auto lerp = [](T from, T to, T share) { return from + share * (to - from); };
  T found[4];
  for (std::size_t n = 0; n < 4; ++n) {
    const auto along_zy = [&](const std::int8_t* at) {
      const auto along_z = [&](const std::int8_t* p) {
        return lerp(T(p[n]), T(p[n + 16]), c.share);
      };
      return lerp(along_z(at), along_z(at + 8), b.share);
    };
    found[n] = lerp(along_zy(corners), along_zy(corners + 4), a.share);
  }
  const T speed = T(guide.speed) / T(127), reach = T(guide.reach) / T(127);
  return {{found[0] * speed, found[1] * speed, found[2] * speed}, found[3] * reach};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SWARM_VELOCITY_H_
