// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The two parts of a swarm's velocity for one animal (simulate/flock/kernels/swarm_kernel.h does
// many at once): noise where it is, and the guide, a grid of directions and wall distances.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SWARM_VELOCITY_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SWARM_VELOCITY_H_

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "simulate/fields/curl_noise.h"
#include "simulate/flock/kernels/swarm_kernel.h"

namespace flocklift {

template <typename T>
struct GuideSample {
  Vec3<T> direction;  // 0 to 1 long
  T distance;         // to the nearest wall [m]
};

template <typename T>
Vec3<T> SwarmNoiseVelocity(const SwarmJob& job, int which, const Vec3<T>& x) {
  const SwarmNoise& noise = job.noise[which];
  const NoiseTerm<T> term{T(noise.gain), T(noise.scale), noise.seed};
  return job.curl ? CurlNoise(term, x) : PerlinVelocity(term, x);
}

// Trilinear: along z, then y, then x.
template <typename T>
GuideSample<T> SampleGuide(const SwarmGrid& grid, const Vec3<T>& x) {
  struct Place {
    std::size_t cell;
    T share;
  };
  const auto place = [&grid](T at, float low, int nodes) -> Place {
    const T u =
        std::min(std::max(T(0), (at - T(low)) * T(grid.per_spacing)), static_cast<T>(nodes - 1));
    const T cell = std::min(std::floor(u), static_cast<T>(nodes - 2));
    return {static_cast<std::size_t>(cell), u - cell};
  };
  const Place a = place(x.x, grid.low_x, grid.nx), b = place(x.y, grid.low_y, grid.ny),
              c = place(x.z, grid.low_z, grid.nz);
  const std::size_t row = 4 * static_cast<std::size_t>(grid.nx);
  const std::size_t plane = row * static_cast<std::size_t>(grid.ny);
  const float* const node = grid.nodes + c.cell * plane + b.cell * row + a.cell * 4;
  const auto lerp = [](T from, T to, T share) { return from + share * (to - from); };
  T found[4];
  for (std::size_t n = 0; n < 4; ++n) {
    const auto along_zy = [&](const float* at) {
      const auto along_z = [&](const float* p) { return lerp(T(p[n]), T(p[n + plane]), c.share); };
      return lerp(along_z(at), along_z(at + row), b.share);
    };
    found[n] = lerp(along_zy(node), along_zy(node + 4), a.share);
  }
  return {{found[0], found[1], found[2]}, found[3]};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SWARM_VELOCITY_H_
