// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/morph_style.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/rng.h"
#include "simulate/flock/kernels/swarm_kernel.h"
#include "simulate/flock/streams.h"

namespace flocklift {

Vec3d WindStyle(const MorphOptions& o, const MorphMoment& now, std::uint64_t rank,
                const Vec3d& before, bool first) {
  const Vec3d mean = o.omega2 * o.wind_speed * Normalized(o.wind);
  const double kept = first ? 0 : std::exp(-now.dt / o.wind_time);
  Rng rng = StreamOf(Stream::kNoise, now.seed, rank, now.step);
  const Vec3d draw{rng.Normal(), rng.Normal(), rng.Normal()};
  return mean + kept * (first ? Vec3d{} : before - mean) +
         o.omega2 * o.wind_speed * std::sqrt(1 - kept * kept) * draw;
}

Vec3d GravityStyle(const MorphOptions& o, double age) {
  return {0, 0, -o.omega2 * std::min(o.gravity * age, o.fall_speed)};
}

void CurlStyle(const MorphOptions& o, std::uint64_t seed, const float* x, const float* y,
               const float* z, std::uint32_t first, std::uint32_t last, float* vx, float* vy,
               float* vz) {
  const SwarmNoise noise{static_cast<float>(o.gain), static_cast<float>(o.scale),
                         static_cast<std::uint32_t>(seed)};
  SwarmJob job{};
  job.x = x;
  job.y = y;
  job.z = z;
  job.noise = &noise;
  job.noise_count = 1;
  job.curl = true;
  job.vx = vx;
  job.vy = vy;
  job.vz = vz;
  FastestSwarmKernel().kernel(job, first, last);
  const auto weight = static_cast<float>(o.omega2);
  for (float* const v : {vx, vy, vz}) {
    for (std::uint32_t k = first; k < last; ++k) v[k] *= weight;
  }
}

}  // namespace flocklift
