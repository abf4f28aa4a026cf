// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sums over lists of neighbours (simulate/flock/near_lists.h), one pair at a time, on any scalar:
// what the kernels (kernels/listed_kernel_inl.h) do in lanes, in the same order.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_LISTED_SUMS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_LISTED_SUMS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulate/flock/near_lists.h"
#include "simulate/flock/pair_forces.h"

namespace flocklift {

// The animals first .. last - 1, whose lists they are. Rules add a pair by themselves,
// rules.Add(dx, dv, &sums), or tell what it says, rules.Pair(dx, dv).
template <typename T, typename Rules>
void SumListedScalar(const Rules& rules, const std::vector<BodyRow<T>>& rows,
                     const PairTask<T>& task, const NearLists& lists, std::uint32_t first,
                     std::uint32_t last) {
  for (std::uint32_t k = first; k < last; ++k) {
    const Vec3<T> x = rows[k].Position(), v = rows[k].Velocity();
    const std::uint32_t eight = (k - first) / 8, lane = (k - first) % 8;
    const auto own = rules.For(v);
    typename Rules::Sums sums;
    for (std::size_t n = lists.begin[eight]; n < lists.begin[eight + 1]; ++n) {
      const BodyRow<T>& other = rows[lists.places[8 * n + lane]];
      const Vec3<T> dx = other.Position() - x, dv = other.Velocity() - v;
      if constexpr (requires { own.Add(dx, dv, &sums); }) {
        own.Add(dx, dv, &sums);
      } else {
        sums += own.Pair(dx, dv);
      }
    }
    const Vec3<T> acceleration = own.Finish(sums);
    task.ax[k] = acceleration.x;
    task.ay[k] = acceleration.y;
    task.az[k] = acceleration.z;
    task.neighbours[k] = sums.Neighbours();
  }
}

inline PairSums SumsOf(const PairTask<float>& task) {
  return {task.ax.data(), task.ay.data(), task.az.data(), task.neighbours.data()};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_LISTED_SUMS_H_
