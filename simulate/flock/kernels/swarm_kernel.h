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

// A direction and the distance to the nearest wall everywhere: for every cell of a grid, x fastest,
// its eight corners (x, then y, then z) of four bytes each, in 127ths of `speed` and of `reach`. A
// cell is 32 bytes on one cache line; that it repeats its neighbours' corners is the price.
// Trilinear within the cell; beyond the grid as at its rim.
struct SwarmGuide {
  const std::int8_t* cells;
  float low_x, low_y, low_z, per_spacing;  // of the first corner [m], and 1 / spacing [1/m]
  int nx, ny, nz;                          // cells
  float speed;                             // [m/s]
  float reach;                             // [m]
};
inline constexpr int kGuideCellBytes = 32;

struct SwarmJob {
  const float *x, *y, *z;  // [m], padded
  const SwarmNoise* noise;
  int noise_count;
  bool curl;            // of the noise; else the noise itself over its scale
  SwarmGuide guide;     // cells null: there is none
  float *vx, *vy, *vz;  // [m/s], written
  float* distance;      // to the nearest wall [m], written if there is a guide
};

// Does the animals first .. last - 1, and may write the padding; first is a multiple of 16.
using SwarmKernel = void (*)(const SwarmJob& job, std::uint32_t first, std::uint32_t last);

// Numbers of the cells in which points are, for minimum-distance enforcement: with c = floor(x
// per_cell - shift) along each axis, c_x + c_y across_y + c_z across_z modulo 2^32.
struct CellJob {
  const float *x, *y, *z;  // [m]
  float per_cell, shift;   // [1/m], in cells
  std::uint32_t across_y, across_z;
  std::uint32_t* cell;  // written
};
// Does the points first .. last - 1, both multiples of 8.
using CellKernel = void (*)(const CellJob& job, std::uint32_t first, std::uint32_t last);

// Of cells so numbered, two along each axis from the lowest on, c + {0, 1} + {0, across_y} +
// {0, across_z}: where is more than one bit set? The bit of a cell is that of its number & `mask`,
// eight a byte.
struct CompanyJob {
  CellJob cells;             // of the lowest; `cell` is not written
  const std::uint8_t* bits;  // the first byte again at the end, and 3 more may be read
  std::uint32_t mask;        // a power of two less 1
};
// Writes those among the points first .. last - 1, both multiples of 8, to `found`, in order, and
// the numbers of their lowest cells to `lowest`; returns how many. Both have room for all.
using CompanyKernel = std::uint32_t (*)(const CompanyJob& job, std::uint32_t first,
                                        std::uint32_t last, std::uint32_t* found,
                                        std::uint32_t* lowest);

// Animals sorted by the cells of a grid (simulate/flock/near_grid.h): which of them are nearer to
// somebody behind them than the sum of their rooms. Each is tested against the rest of its own cell
// and the next one, and, if it is at the rim of its cell, in each of four rows against three cells
// around its own shifted by that.
inline constexpr std::uint32_t kNearAtRim = 0x80000000U;  // added to the number of the cell
struct NearJob {
  const float *x, *y, *z, *room;  // [m], sorted, 16 more may be read
  const std::uint32_t* cell;      // of each
  const std::uint32_t* start;     // of each cell's run; the next entry is its end
  std::uint32_t row[4];
};
// Writes those among first .. last - 1 to `found`, in order, and returns how many; `found` has room
// for all.
using NearKernel = std::uint32_t (*)(const NearJob& job, std::uint32_t first, std::uint32_t last,
                                     std::uint32_t* found);

// Animals sorted by buckets (simulate/flock/close_table.h): which of them are nearer to somebody
// behind them than the sum of their rooms. Each is tested against those behind it in two buckets
// from each of (lowest + {0, across_y} + {0, across_z}) & mask on; the first follows the last.
struct CloseJob {
  const float *x, *y, *z, *room;  // [m], sorted, 16 more may be read
  const std::uint32_t* lowest;    // of each
  const std::uint32_t* start;     // of each bucket's run; the end of all follows twice
  std::uint32_t across_y, across_z, mask;
};
// As NearKernel.
using CloseKernel = std::uint32_t (*)(const CloseJob& job, std::uint32_t first, std::uint32_t last,
                                      std::uint32_t* found);

struct SwarmKernelVariant {
  const char* name;
  bool (*supported)();  // by this machine
  SwarmKernel kernel;
  CellKernel cells;
  CompanyKernel company;
  NearKernel near;
  CloseKernel close;
};

// From the most portable to the fastest.
inline constexpr int kSwarmKernelVariants = 3;
extern const SwarmKernelVariant kSwarmKernels[kSwarmKernelVariants];

void SwarmKernelSse2(const SwarmJob& job, std::uint32_t first, std::uint32_t last);
void CellKernelSse2(const CellJob& job, std::uint32_t first, std::uint32_t last);
std::uint32_t CompanyKernelSse2(const CompanyJob& job, std::uint32_t first, std::uint32_t last,
                                std::uint32_t* found, std::uint32_t* lowest);
std::uint32_t NearKernelSse2(const NearJob& job, std::uint32_t first, std::uint32_t last,
                             std::uint32_t* found);
std::uint32_t CloseKernelSse2(const CloseJob& job, std::uint32_t first, std::uint32_t last,
                              std::uint32_t* found);
void SwarmKernelAvx2(const SwarmJob& job, std::uint32_t first, std::uint32_t last);
void CellKernelAvx2(const CellJob& job, std::uint32_t first, std::uint32_t last);
std::uint32_t CompanyKernelAvx2(const CompanyJob& job, std::uint32_t first, std::uint32_t last,
                                std::uint32_t* found, std::uint32_t* lowest);
std::uint32_t NearKernelAvx2(const NearJob& job, std::uint32_t first, std::uint32_t last,
                             std::uint32_t* found);
std::uint32_t CloseKernelAvx2(const CloseJob& job, std::uint32_t first, std::uint32_t last,
                              std::uint32_t* found);
void SwarmKernelAvx512(const SwarmJob& job, std::uint32_t first, std::uint32_t last);
void CellKernelAvx512(const CellJob& job, std::uint32_t first, std::uint32_t last);
std::uint32_t CompanyKernelAvx512(const CompanyJob& job, std::uint32_t first, std::uint32_t last,
                                  std::uint32_t* found, std::uint32_t* lowest);
std::uint32_t NearKernelAvx512(const NearJob& job, std::uint32_t first, std::uint32_t last,
                               std::uint32_t* found);
std::uint32_t CloseKernelAvx512(const CloseJob& job, std::uint32_t first, std::uint32_t last,
                                std::uint32_t* found);

// The same, one animal at a time.
void SwarmKernelScalar(const SwarmJob& job, std::uint32_t first, std::uint32_t last);

// The fastest variant that this machine has.
const SwarmKernelVariant& FastestSwarmKernel();

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_H_
