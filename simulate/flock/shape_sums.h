// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What neighbours do in a shape-constrained swarm (simulate/flock/shape_pairs.h), summed over lists
// of neighbours: kept ones, or such as are written for a few animals at a time where keeping them
// would not pay or take too much room. Kernels and threads change no byte.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SHAPE_SUMS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SHAPE_SUMS_H_

#include <algorithm>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/flock/kernels/kernels.h"
#include "simulate/flock/near_lists.h"
#include "simulate/flock/pair_forces.h"
#include "simulate/flock/shape_pairs.h"
#include "simulate/flock/verlet_lists.h"

namespace flocklift {

// How far a neighbour can be felt, and nobody beyond.
template <typename T>
NearReach<T> ReachOf(const ShapePairNumbers& n) {
  return {static_cast<T>(std::max({n.r_rep, n.r_ali, n.r_att})), static_cast<T>(n.reach)};
}

// The accelerations that neighbours cause. Without kept lists the task's grid must be sorted by
// Reach(n) at least, and `rows` is room that may be used again; there is no sample.
template <typename T>
void SumPairs(const ShapePairNumbers& n, const KernelVariant* kernel, const PairTask<T>& task,
              const VerletLists<T>* kept, ThreadPool* pool, std::vector<BodyRow<T>>* rows);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SHAPE_SUMS_H_
