// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The body of every variant of the swarm kernel; included once by each, after it has defined
//   void LerpNodes(const float* node, size_t row, size_t plane, float u, float v, float w, float*)
// which blends the four numbers of eight nodes: along z, then y, then x, each a + t (b - a).
// Everything lives in an anonymous namespace (boids_kernel.h says why).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_INL_H_

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/fields/curl_noise.h"
#include "simulate/flock/kernels/lattice_pack.h"
#include "simulate/flock/kernels/swarm_kernel.h"

namespace flocklift {
namespace {

// Where a pack of animals is along one axis of the grid.
template <typename Pack>
struct GridPlace {
  Pack cell;   // lower node
  Pack share;  // of the way to the next
};

template <typename Pack>
GridPlace<Pack> PlaceOnGrid(const Pack& x, float low, float per_spacing, int nodes) {
  const Pack u = xsimd::min(xsimd::max(Pack(0.0f), (x - Pack(low)) * Pack(per_spacing)),
                            Pack(static_cast<float>(nodes - 1)));
  const Pack cell = xsimd::min(xsimd::floor(u), Pack(static_cast<float>(nodes - 2)));
  return {cell, u - cell};
}

// Adds speed times the grid's direction to v; the return is the distance.
template <typename Pack>
Pack AddGuide(const SwarmGrid& grid, float speed, const Vec3<Pack>& x, Vec3<Pack>* v) {
  constexpr std::size_t kLanes = Pack::size;
  const GridPlace<Pack> a = PlaceOnGrid(x.x, grid.low_x, grid.per_spacing, grid.nx);
  const GridPlace<Pack> b = PlaceOnGrid(x.y, grid.low_y, grid.per_spacing, grid.ny);
  const GridPlace<Pack> c = PlaceOnGrid(x.z, grid.low_z, grid.per_spacing, grid.nz);
  alignas(64) float cells[3][kLanes], shares[3][kLanes], found[kLanes][4], columns[4][kLanes];
  a.cell.store_aligned(cells[0]);
  b.cell.store_aligned(cells[1]);
  c.cell.store_aligned(cells[2]);
  a.share.store_aligned(shares[0]);
  b.share.store_aligned(shares[1]);
  c.share.store_aligned(shares[2]);
  const std::size_t row = 4 * static_cast<std::size_t>(grid.nx);
  const std::size_t plane = row * static_cast<std::size_t>(grid.ny);
  for (std::size_t k = 0; k < kLanes; ++k) {
    const float* const node = grid.nodes + static_cast<std::uint32_t>(cells[2][k]) * plane +
                              static_cast<std::uint32_t>(cells[1][k]) * row +
                              static_cast<std::uint32_t>(cells[0][k]) * 4U;
    LerpNodes(node, row, plane, shares[0][k], shares[1][k], shares[2][k], found[k]);
  }
  for (std::size_t k = 0; k < kLanes; ++k) {
    for (std::size_t n = 0; n < 4; ++n) columns[n][k] = found[k][n];
  }
  const Pack s(speed);
  v->x += Pack::load_aligned(columns[0]) * s;
  v->y += Pack::load_aligned(columns[1]) * s;
  v->z += Pack::load_aligned(columns[2]) * s;
  return Pack::load_aligned(columns[3]);
}

template <typename Pack>
void SwarmVelocities(const SwarmJob& job, std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t k = first; k < last; k += Pack::size) {
    const Vec3<Pack> x{Pack::load_unaligned(job.x + k), Pack::load_unaligned(job.y + k),
                       Pack::load_unaligned(job.z + k)};
    Vec3<Pack> v{Pack(0.0f), Pack(0.0f), Pack(0.0f)};
    for (int n = 0; n < job.noise_count; ++n) {
      const SwarmNoise& noise = job.noise[n];
      const NoiseTerm<Pack> term{Pack(noise.gain), Pack(noise.scale), noise.seed};
      v += job.curl ? CurlNoise(term, x) : PerlinVelocity(term, x);
    }
    if (job.grid.nodes != nullptr) {
      AddGuide(job.grid, job.speed, x, &v).store_unaligned(job.distance + k);
    }
    v.x.store_unaligned(job.vx + k);
    v.y.store_unaligned(job.vy + k);
    v.z.store_unaligned(job.vz + k);
  }
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_INL_H_
