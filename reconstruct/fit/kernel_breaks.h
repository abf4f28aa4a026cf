// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where pairs of animals are, and where a kernel's spline gets its breaks from it: so that equal
// shares of
//   w(r) = a + b r rho(r) + c |phi''(r)|^(1/3)
// lie between them, each part scaled to its share of the whole: distances as such, the pairs'
// leverage on phi, and, once there is a kernel, how it bends (de Boor's rule for piecewise-linear
// slopes).

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_BREAKS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_BREAKS_H_

#include <functional>
#include <vector>

#include "reconstruct/fit/observed_flock.h"

namespace flocklift {

// rho: distances of all pairs of animals in all frames, but thinned frames when there are many.
struct PairDensity {
  double low = 0, high = 0;   // of all distances within reach [m]
  std::vector<double> share;  // of the pairs, in equal cells from low to high
  double pairs = 0;

  bool IsUsable() const { return high > low && pairs > 0; }
  double Cell() const { return (high - low) / static_cast<double>(share.size()); }
  double Middle(std::size_t cell) const { return low + (static_cast<double>(cell) + 0.5) * Cell(); }
  // rho at a distance [1/m], as the mean of the cells within `half_width`.
  double At(double distance, double half_width) const;
};

PairDensity MeasurePairs(const std::vector<ObservedFlock>& flocks, double reach);

// At most so many intervals: none is much shorter than `shortest`, below which nothing can be seen
// [m]. `bend` is |phi''|; empty: no such part.
std::vector<double> ChooseBreaks(const PairDensity& pairs, int intervals, double shortest,
                                 const std::function<double(double)>& bend);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_BREAKS_H_
