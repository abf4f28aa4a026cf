// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The inner loops of flock morphing, one variant per instruction set, chosen at run time: where
// each tetrahedron flies in a step, and where its corners are then. Lanes hold tetrahedra; nothing
// is contracted into fused operations: all variants give the same bytes. Plain pointers and no
// shared inline code, for the reasons in kernels.h.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_MORPH_KERNEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_MORPH_KERNEL_H_

#include <cstdint>

namespace flocklift {

// What a tetrahedron does is told by its progress: it waits, follows the path, or has come near its
// place and is at a share of the way from there to it; at 1 it has arrived.
inline constexpr float kWaits = -2, kFollows = -1;

// A cell for each bit, x fastest: where somebody turns to its place (target_region.h).
struct MorphRegion {
  const std::uint8_t* cells;            // null: all of the sphere about it
  float low_x, low_y, low_z, per_cell;  // of the first cell [m], and 1 / its edge [1/m]
  std::int32_t nx, ny, nz;              // cells
  float sphere_x, sphere_y, sphere_z, squared_reach;  // [m, m^2]
};

// Around some tetrahedra.
struct MorphBox {
  float low[3], high[3];  // [m]
};

// Arrays are by rank and padded; a kernel may write to the padding.
struct MorphMoveJob {
  float *x, *y, *z;                       // centroids [m]
  float *before_x, *before_y, *before_z;  // written: what they were [m]
  float* progress;
  float* room;  // written: kept about each [m], not a number for who keeps none; null: nobody does
  const float *way_x, *way_y, *way_z;        // unit direction of the own path segment
  const float* gate;                         // along it, where the next one begins [m]
  const float *path_x, *path_y, *path_z;     // a point of the own segment; null: no width [m]
  const float *style_x, *style_y, *style_z;  // omega2 V_l; null: none [m/s]
  const float *place_x, *place_y, *place_z;  // centroids of the targets [m]
  float path_speed, speed;                   // omega1 speed0, speed0 [m/s]
  float half_width, pull;                    // [m], [1/s]
  float dt;                                  // [s]
  float most_room, spaced_until;             // of who follows [m]; progress
  MorphRegion region;
};

inline constexpr std::uint32_t kMorphInRegion = 0x80000000U;  // added to the number of who is

// Moves first .. last - 1 (first a multiple of 16) and lists those that passed their gate or are
// in the region, while they follow the path; room for last - first + 8 numbers. Returns how many.
// `box` is widened to hold all, and up to 15 before and after them.
using MorphMoveKernel = std::uint32_t (*)(const MorphMoveJob& job, std::uint32_t first,
                                          std::uint32_t last, std::uint32_t* events, MorphBox* box);

struct MorphShapeJob {
  const float *x, *y, *z, *progress;
  const float* departure;                 // when each leaves [s]
  const float* corner[9];                 // of the source about its centroid: corners 0 .. 2 by xyz
  const float* stretched[9];              // S times these [m]
  const float *axis_x, *axis_y, *axis_z;  // of the rotation
  const float* half_angle;                // [rad], in [0, pi / 2]
  float* vertex[12];                      // corners 0 .. 3 by xyz, written [m]
  float now;                              // [s]
  float shrink, per_shrink_time;          // edge in flight / at rest, [1/s]
  float morph_share;                      // of the last leg; the rest is for growing
  bool shoemake;
};
using MorphShapeKernel = void (*)(const MorphShapeJob& job, std::uint32_t first,
                                  std::uint32_t last);

struct MorphKernelVariant {
  const char* name;
  bool (*supported)();  // by this machine
  MorphMoveKernel move;
  MorphShapeKernel shape;
};

// From the most portable to the fastest.
inline constexpr int kMorphKernelVariants = 2;
extern const MorphKernelVariant kMorphKernels[kMorphKernelVariants];

std::uint32_t MorphMoveSse2(const MorphMoveJob& job, std::uint32_t first, std::uint32_t last,
                            std::uint32_t* events, MorphBox* box);
void MorphShapeSse2(const MorphShapeJob& job, std::uint32_t first, std::uint32_t last);
std::uint32_t MorphMoveAvx2(const MorphMoveJob& job, std::uint32_t first, std::uint32_t last,
                            std::uint32_t* events, MorphBox* box);
void MorphShapeAvx2(const MorphShapeJob& job, std::uint32_t first, std::uint32_t last);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_MORPH_KERNEL_H_
