// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/kernels/swarm_kernel.h"

#include "simulate/flock/swarm_velocity.h"

namespace flocklift {

const SwarmKernelVariant kSwarmKernels[kSwarmKernelVariants] = {
    {"sse2", [] { return true; }, SwarmKernelSse2, CellKernelSse2, CompanyKernelSse2,
     NearKernelSse2, CloseKernelSse2},
    {"avx2",
     [] { return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; },
     SwarmKernelAvx2, CellKernelAvx2, CompanyKernelAvx2, NearKernelAvx2, CloseKernelAvx2},
    {"avx512",
     [] { return __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("fma") != 0; },
     SwarmKernelAvx512, CellKernelAvx512, CompanyKernelAvx512, NearKernelAvx512, CloseKernelAvx512},
};

void SwarmKernelScalar(const SwarmJob& job, std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t k = first; k < last; ++k) {
    const Vec3<float> x{job.x[k], job.y[k], job.z[k]};
    Vec3<float> v{0, 0, 0};
    for (int n = 0; n < job.noise_count; ++n) v += SwarmNoiseVelocity(job, n, x);
    if (job.guide.cells != nullptr) {
      const GuideSample<float> guide = SampleGuide<float>(job.guide, x);
      v += guide.velocity;
      job.distance[k] = guide.distance;
    }
    job.vx[k] = v.x;
    job.vy[k] = v.y;
    job.vz[k] = v.z;
  }
}

const SwarmKernelVariant& FastestSwarmKernel() {
  const SwarmKernelVariant* best = nullptr;
  for (const SwarmKernelVariant& variant : kSwarmKernels) {
    if (variant.supported()) best = &variant;
  }
  return *best;
}

}  // namespace flocklift
