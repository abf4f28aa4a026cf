// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The inner loop of boids, one variant per instruction set, chosen at run time.
//
// Lanes hold animals, a tile of consecutive ones in a row of cells; their candidates are those of
// the touching rows that are within reach of the tile's bounding box, one after the other for all
// lanes. So every animal sums its neighbours in the order of the sort, whatever the width of a
// pack, and nothing is contracted into fused operations: all variants give the same bytes.
//
// The variants are compiled with flags of their own. Hence this interface of plain pointers, and
// no inline function or template that another file could share: the linker keeps only one of each.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_BOIDS_KERNEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_BOIDS_KERNEL_H_

#include <cstdint>

namespace flocklift {

// Input and output of the kernel. Arrays are those of Bodies<float>, sorted and padded; the grid is
// CellGrid<float>::View.
struct BoidsJob {
  const std::uint32_t* start;
  float low_x, inverse_edge;
  int nx, ny, nz;
  const float *x, *y, *z, *vx, *vy, *vz;
  float d_s, d_v, alpha_s, alpha_c, alpha_a, taper;
  float reach;
  float *ax, *ay, *az;  // [m/s^2], written
  float* neighbours;    // weight of those within d_v, written
};

// Input and output of the move, the same arrays. A move may touch the padding.
struct MoveJob {
  float *x, *y, *z, *vx, *vy, *vz;
  const float *ax, *ay, *az;
  float dt, s_min, s_max;
};

// Does the animals of the rows of cells first_row .. last_row - 1. `candidates` is room for as many
// numbers as there are animals, and 32 more.
using BoidsKernel = void (*)(const BoidsJob& job, int first_row, int last_row,
                             std::uint32_t* candidates);

// Advance (simulate/flock/integrator.h) for animals first .. last - 1; first is a multiple of 16.
using MoveKernel = void (*)(const MoveJob& job, std::uint32_t first, std::uint32_t last);

struct BoidsKernelVariant {
  const char* name;
  bool (*supported)();  // by this machine
  BoidsKernel kernel;
  MoveKernel move;
};

// From the most portable to the fastest.
inline constexpr int kBoidsKernelVariants = 3;
extern const BoidsKernelVariant kBoidsKernels[kBoidsKernelVariants];

void BoidsKernelSse2(const BoidsJob& job, int first_row, int last_row, std::uint32_t* candidates);
void MoveKernelSse2(const MoveJob& job, std::uint32_t first, std::uint32_t last);
void BoidsKernelAvx2(const BoidsJob& job, int first_row, int last_row, std::uint32_t* candidates);
void MoveKernelAvx2(const MoveJob& job, std::uint32_t first, std::uint32_t last);
void BoidsKernelAvx512(const BoidsJob& job, int first_row, int last_row, std::uint32_t* candidates);
void MoveKernelAvx512(const MoveJob& job, std::uint32_t first, std::uint32_t last);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_BOIDS_KERNEL_H_
