// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lists of neighbours that are kept over several steps (L. Verlet, Phys. Rev. 159, 98, 1967): they
// hold everybody who is within reach or a skin beyond. Two animals come nearer by no more than both
// have moved; so a list is complete as long as twice the farthest move is less than the skin. What
// all have moved together does not count: moves are taken from the middle of all moves.
//
// They pay where they last: what a step then costs is the pairs within reach and little more, while
// a grid that is sorted anew offers several times as many.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_VERLET_LISTS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_VERLET_LISTS_H_

#include <cstddef>
#include <vector>

#include "simulate/core/large_pages.h"
#include "simulate/core/parallel_for.h"
#include "simulate/core/state_archive.h"
#include "simulate/flock/herd.h"
#include "simulate/flock/kernels/kernels.h"
#include "simulate/flock/near_lists.h"

namespace flocklift {

// For UpdateIfWorth: wider lists last longer and hold more.
inline constexpr double kListSkin = 0.12;

template <typename T>
class VerletLists {
 public:
  // `skin` is a share of the reach; 0 makes new lists for every change.
  explicit VerletLists(double skin) : skin_(skin) {}

  // Takes the memory that UpdateIfWorth would, ahead of the first step and each thread that of its
  // share: what is written for the first time costs far more than what is written again. Nothing
  // where lists should not last.
  void Reserve(const NearReach<T>& reach, double dt, const KernelVariant* kernel, ThreadPool* pool,
               const Bodies<T>& now);

  // Sees to it that everybody within reach is listed. Where that takes new lists, the herd is
  // brought into a new order.
  void Update(const NearReach<T>& reach, const KernelVariant* kernel, ThreadPool* pool,
              Herd<T>* herd);
  // The same, but new lists are made only where they should last for several steps of `dt` [s], at
  // the velocities of now, and are not long; not for a few hundred animals. Otherwise there are
  // none, and the herd's order is any.
  bool UpdateIfWorth(const NearReach<T>& reach, double dt, const KernelVariant* kernel,
                     ThreadPool* pool, Herd<T>* herd);

  // Of the animals from kListGrain * chunk on.
  const NearLists& chunk(std::size_t chunk) const { return chunks_[chunk]; }
  // The animals at the last update, in the herd's order.
  const std::vector<BodyRow<T>>& rows() const { return rows_; }

  // The lists depend on where the animals were when they were made.
  void Save(StateWriter* out) const;
  void Load(StateReader* in);

 private:
  // Fills the rows where they do.
  bool Hold(const NearReach<T>& reach, const KernelVariant* kernel, ThreadPool* pool,
            const Bodies<T>& now);
  void Renew(const NearReach<T>& reach, ThreadPool* pool, Herd<T>* herd);
  void Make(const KernelVariant* kernel, ThreadPool* pool, const CellGrid<T>& grid,
            const Bodies<T>& bodies);
  void MakeChunks(std::size_t animals);
  bool ShouldLast(const NearReach<T>& reach, double dt, ThreadPool* pool,
                  const Bodies<T>& now) const;

  double skin_;
  NearReach<T> listed_{T(-1), T(-1)};  // what the lists hold; below 0: there are none
  std::vector<T> x_, y_, z_;           // where the animals were then, in the herd's order [m]
  bool loaded_ = false;                // all but the lists themselves
  LargePages memory_;                  // of the lists
  std::vector<NearLists> chunks_;
  std::vector<BodyRow<T>> rows_;
};

extern template class VerletLists<float>;
extern template class VerletLists<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_VERLET_LISTS_H_
