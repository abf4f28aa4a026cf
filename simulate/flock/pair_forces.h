// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What neighbours do to each other: the rules of boids, of three zones or of OpenSteer, summed over
// the neighbours of every animal of a sorted swarm. Those are metric, all within reach, found with
// the cell grid and summed by the SIMD kernels or, pair by pair, with the same terms on any scalar;
// or topological, the nearest few of every animal whatever their distance (Ballerini et al. 2008).
// The order of every sum depends on the state alone, so kernels and threads change no byte. Metric
// neighbours of boids and zones may be listed instead (simulate/flock/verlet_lists.h).
//
// Where nearly everybody is everybody's neighbour a sample caps the work: the animals of a row of
// cells then have every stride-th of their candidates for neighbours, in the order of the sort, so
// that the sample is spread over space; another one at every step. Means stay unbiased.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_PAIR_FORCES_H_
#define FLOCKLIFT_SIMULATE_FLOCK_PAIR_FORCES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/flock/bodies.h"
#include "simulate/flock/boids.h"
#include "simulate/flock/cell_grid.h"
#include "simulate/flock/herd.h"
#include "simulate/flock/kernels/kernels.h"
#include "simulate/flock/steer_pairs.h"
#include "simulate/flock/verlet_lists.h"
#include "simulate/flock/zone_pairs.h"

namespace flocklift {

// The kernels of that name, or the fastest that this machine has; null for "scalar". Throws
// std::invalid_argument where there is none.
const KernelVariant* ChooseKernel(const std::string& name);

// For each animal its neighbours, by their numbers in the order of the sort, ascending.
using NeighbourLists = std::vector<std::vector<std::uint32_t>>;

// A swarm in the order of its grid, and where the sums go. All by reference; columns are padded as
// those of Bodies.
template <typename T>
struct PairTask {
  const CellGrid<T>& grid;
  const Bodies<T>& bodies;
  std::vector<T>&ax, &ay, &az;                     // [m/s^2], written
  std::vector<T>& neighbours;                      // how many, by weight, written
  const std::vector<RowSample>* sample = nullptr;  // of each row of cells; null: everybody
  const NeighbourLists* nearest = nullptr;         // topological neighbours; null: metric ones
  const VerletLists<T>* lists = nullptr;           // of the metric ones; null: by the grid
};
template <typename T>
PairTask<T> TaskOf(Herd<T>* herd) {
  return {herd->grid, herd->now, herd->ax, herd->ay, herd->az, herd->neighbours};
}

// The accelerations that neighbours cause; boids with seconds for time units. For SteerParameters
// the bodies' velocities must be headings, of length 1. The grid must be sorted by Reach(p) at
// least, or there are lists of at least that reach. A null kernel, or a scalar that is not float,
// goes pair by pair. Of topological neighbours all are in the sight of boids (d_v does not count);
// other radii stay what they are.
template <typename T>
void SumPairs(const BoidsParameters<double>& p, const KernelVariant* kernel,
              const PairTask<T>& task, ThreadPool* pool);
template <typename T>
void SumPairs(const ZoneParameters& p, const KernelVariant* kernel, const PairTask<T>& task,
              ThreadPool* pool);
template <typename T>
void SumPairs(const SteerParameters& p, const KernelVariant* kernel, const PairTask<T>& task,
              ThreadPool* pool);

// The `count` nearest others of every animal (FLANN's kd-tree, exact), all where there are fewer.
template <typename T>
NeighbourLists FindNearest(const Bodies<T>& bodies, int count, ThreadPool* pool);

// A sample that leaves every animal about `most` candidates, most >= 1.
template <typename T>
void SampleRows(const CellGrid<T>& grid, std::uint32_t most, std::uint32_t step,
                std::vector<RowSample>* rows);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_PAIR_FORCES_H_
