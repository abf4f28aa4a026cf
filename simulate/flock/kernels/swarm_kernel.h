// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The velocities of a noise-aware swarm (simulate/flock/swarm_motion.h), one variant per
// instruction set, chosen at run time: noise evaluated where each animal is, plus what a grid says
// there. Lanes hold animals, and every lane does what the scalar code does in the same order: all
// variants give the same bytes. As boids_kernel.h says, this interface shares no code with other
// files.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_H_

#include <cstdint>

namespace flocklift {

// One potential of the noise, NoiseTerm<float> in plain numbers.
struct SwarmNoise {
  float gain, scale;
  std::uint32_t seed;
};

// A grid of four numbers a node, x fastest, at least two nodes along each axis: a direction, and
// the distance to the nearest wall [m]. Trilinear between the nodes; beyond them as at the rim.
struct SwarmGrid {
  const float* nodes;
  float low_x, low_y, low_z, per_spacing;  // of the first node [m], and 1 / spacing [1/m]
  int nx, ny, nz;
};

struct SwarmJob {
  const float *x, *y, *z;  // [m], padded
  const SwarmNoise* noise;
  int noise_count;
  bool curl;            // of the noise; else the noise itself over its scale
  SwarmGrid grid;       // nodes null: there is none
  float speed;          // times the direction of the grid [m/s]
  float *vx, *vy, *vz;  // [m/s], written
  float* distance;      // to the nearest wall [m], written if there is a grid
};

// Does the animals first .. last - 1, and may write the padding; first is a multiple of 16.
using SwarmKernel = void (*)(const SwarmJob& job, std::uint32_t first, std::uint32_t last);

struct SwarmKernelVariant {
  const char* name;
  bool (*supported)();  // by this machine
  SwarmKernel kernel;
};

// From the most portable to the fastest.
inline constexpr int kSwarmKernelVariants = 3;
extern const SwarmKernelVariant kSwarmKernels[kSwarmKernelVariants];

void SwarmKernelSse2(const SwarmJob& job, std::uint32_t first, std::uint32_t last);
void SwarmKernelAvx2(const SwarmJob& job, std::uint32_t first, std::uint32_t last);
void SwarmKernelAvx512(const SwarmJob& job, std::uint32_t first, std::uint32_t last);

// The same, one animal at a time.
void SwarmKernelScalar(const SwarmJob& job, std::uint32_t first, std::uint32_t last);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_H_
