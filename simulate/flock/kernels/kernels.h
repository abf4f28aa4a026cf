// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The inner loops over pairs, one variant per instruction set, chosen at run time.
//
// Lanes hold animals, a tile of consecutive ones in a row of cells; their candidates are those of
// the touching rows that are within reach of the tile's bounding box, one after the other for all
// lanes. So every animal sums its neighbours in the order of the sort, whatever the width of a
// pack, and nothing is contracted into fused operations that round otherwise: all variants give the
// same bytes. So do listed neighbours, each lane taking those of its own animal's list. Zones by
// the grid (with hard edges and no sample) are taken animal by animal, lanes holding the
// neighbours, in eight sums whatever the width of a pack.
//
// The variants are compiled with flags of their own. Hence this interface of plain pointers, and
// no inline function or template that another file could share: the linker keeps only one of each.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_KERNELS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_KERNELS_H_

#include <cstddef>
#include <cstdint>

namespace flocklift {

// Which candidates the animals of a row of cells have: those whose number in the order of the sort
// is `phase` modulo `stride`.
struct RowSample {
  std::uint32_t stride, phase;  // stride 1: all
};

// Lists of neighbours (simulate/flock/near_lists.h) of the animals that are asked for.
struct ListedPairs {
  const float* rows;           // BodyRow
  const std::uint32_t* begin;  // of the lists
  const std::uint32_t* places;
};

// Where sums go: accelerations [m/s^2], and how many neighbours there are, by weight.
struct PairSums {
  float *ax, *ay, *az, *neighbours;
};

// What every pair kernel reads and writes. Arrays are those of Bodies<float>, sorted and padded;
// the grid is CellGrid<float>::View.
struct PairJob {
  const std::uint32_t* start;
  float low_x, inverse_edge;
  int nx, ny, nz;
  const float *x, *y, *z, *vx, *vy, *vz;
  float reach;
  const RowSample* sample;  // of each row; null: everybody
  ListedPairs listed;       // instead of all that; null: by the grid
  PairSums sums;
};

// The rules' numbers, as MakeBoidsPairs, MakeZonePairs and MakeSteerPairs name them.
struct BoidsJob {
  PairJob pairs;
  float d_s, d_v, alpha_s, alpha_c, alpha_a, taper;
  bool cone;  // whether there is a blind angle
  float view_cosine, view_taper;
};
struct ZonesJob {
  PairJob pairs;
  float r_rep, r_ali, r_att, w_rep, w_ali, w_att, taper;
};
// Lists of neighbours (simulate/flock/near_lists.h). `pairs` has no velocities, no reach, no sample
// and nothing to write.
struct ListJob {
  PairJob pairs;
  float straight, manhattan;  // NearReach
  float margin;               // of the boxes around tiles, against rounding
  std::uint32_t nobody;
  std::uint32_t *candidates, *near;  // room for as many numbers as there are animals, and 32 more
  float* columns;                    // three of them, each this long
  std::size_t column;
  // Where the first eight lists begin in `places`; the others are written, and the end.
  std::uint32_t* begin;
  std::uint32_t* places;
  std::size_t room;  // of places
};
struct ShapeJob {  // ShapePairNumbers
  ListedPairs listed;
  float r_rep, r_ali, r_att, w_rep, w_ali, w_att;
  float w_con, reach, sigma;
  PairSums sums;
};
struct SteerJob {  // the velocities are headings
  PairJob pairs;
  struct Rule {
    float weight, radius, cosine;
  } separation, alignment, cohesion;
  float near, taper, view_taper;
};

// Input and output of the move, the same arrays. A move may touch the padding.
struct MoveJob {
  float *x, *y, *z, *vx, *vy, *vz;
  const float *ax, *ay, *az;
  float dt, s_min, s_max;
};

struct KernelVariant {
  const char* name;
  bool (*supported)();  // by this machine

  // The animals first .. last - 1. `candidates` is room for as many numbers as there are animals,
  // and 32 more.
  void (*boids)(const BoidsJob& job, std::uint32_t first, std::uint32_t last,
                std::uint32_t* candidates);
  void (*zones)(const ZonesJob& job, std::uint32_t first, std::uint32_t last,
                std::uint32_t* candidates);
  void (*steer)(const SteerJob& job, std::uint32_t first, std::uint32_t last,
                std::uint32_t* candidates);

  // Lists the neighbours of the animals from `first` on, in eights, as far as there is room;
  // returns the first that is not listed.
  std::uint32_t (*list)(const ListJob& job, std::uint32_t first, std::uint32_t last);
  // The animals first .. last - 1, whose neighbours are listed.
  void (*shape)(const ShapeJob& job, std::uint32_t first, std::uint32_t last);

  // Advance (simulate/flock/integrator.h) for animals first .. last - 1; first is a multiple of 16.
  void (*move)(const MoveJob& job, std::uint32_t first, std::uint32_t last);
};

// From the most portable to the fastest.
extern const KernelVariant kSse2Kernels, kAvx2Kernels, kAvx512Kernels;
inline constexpr int kKernelVariants = 3;
extern const KernelVariant* const kKernels[kKernelVariants];

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_KERNELS_H_
