// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/verlet_lists.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flocklift {
namespace {

constexpr double kMoveMargin = 1.001;  // against rounding
constexpr std::size_t kLanes = 8;      // taken together, which compilers know how to do

template <typename T>
struct Moves {
  const std::vector<T>&now, &then;
  T operator[](std::size_t k) const { return now[k] - then[k]; }
};

// The middle between the least and the greatest; over whole lanes first, the order does not count.
template <typename T>
T Middle(const Moves<T>& moves, std::size_t n) {
  T low[kLanes], high[kLanes];
  std::fill(low, low + kLanes, moves[0]);
  std::fill(high, high + kLanes, moves[0]);
  const auto take = [&](std::size_t lane, T move) {
    low[lane] = move < low[lane] ? move : low[lane];
    high[lane] = move > high[lane] ? move : high[lane];
  };
  std::size_t k = 0;
  for (; k + kLanes <= n; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) take(lane, moves[k + lane]);
  }
  for (; k < n; ++k) take(0, moves[k]);
  return T(0.5) * (*std::min_element(low, low + kLanes) + *std::max_element(high, high + kLanes));
}

// Infinite where a move is no finite number.
template <typename T>
double Farthest(const Moves<T> (&moves)[3], std::size_t n) {
  const Vec3<T> middle{Middle(moves[0], n), Middle(moves[1], n), Middle(moves[2], n)};
  T most[kLanes] = {}, sum[kLanes] = {};  // what is no number shows in the sum
  const auto take = [&](std::size_t lane, std::size_t k) {
    const T x = moves[0][k] - middle.x, y = moves[1][k] - middle.y, z = moves[2][k] - middle.z;
    const T squared = x * x + y * y + z * z;
    most[lane] = squared > most[lane] ? squared : most[lane];
    sum[lane] += squared;
  };
  std::size_t k = 0;
  for (; k + kLanes <= n; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) take(lane, k + lane);
  }
  for (; k < n; ++k) take(0, k);
  const bool finite =
      std::all_of(sum, sum + kLanes, [](const T& value) { return std::isfinite(value); });
  if (!finite) return std::numeric_limits<double>::infinity();
  return std::sqrt(static_cast<double>(*std::max_element(most, most + kLanes)));
}

}  // namespace

template <typename T>
bool VerletLists<T>::Hold(const NearReach<T>& reach, const Bodies<T>& now) const {
  if (listed_.straight < reach.straight || listed_.manhattan < reach.manhattan) return false;
  const Moves<T> moves[3] = {{now.x, x_}, {now.y, y_}, {now.z, z_}};
  const double nearer = 2 * kMoveMargin * Farthest(moves, now.size());
  return reach.straight + nearer <= listed_.straight &&
         reach.manhattan + std::sqrt(3.0) * nearer <= listed_.manhattan;
}

template <typename T>
void VerletLists<T>::Update(const NearReach<T>& reach, const KernelVariant* kernel,
                            ThreadPool* pool, Herd<T>* herd) {
  if (herd->size() == 0) return;
  if (Hold(reach, herd->now)) {
    if (loaded_) {  // as they were made, in the order that is there already
      Bodies<T> then = herd->now, sorted;
      then.x = x_;
      then.y = y_;
      then.z = z_;
      CellGrid<T> grid;
      grid.Sort(then, listed_.Farthest(), &sorted, pool);
      Make(kernel, pool, grid, sorted);
      loaded_ = false;
    }
    return;
  }
  const double skin = skin_ * reach.Farthest();
  listed_ = {static_cast<T>(reach.straight + skin),
             static_cast<T>(reach.manhattan + std::sqrt(3.0) * skin)};
  herd->SortBy(listed_.Farthest(), pool);
  x_ = herd->now.x;
  y_ = herd->now.y;
  z_ = herd->now.z;
  loaded_ = false;
  Make(kernel, pool, herd->grid, herd->now);
}

template <typename T>
void VerletLists<T>::Make(const KernelVariant* kernel, ThreadPool* pool, const CellGrid<T>& grid,
                          const Bodies<T>& bodies) {
  const auto n = static_cast<std::int64_t>(bodies.size());
  chunks_.resize(static_cast<std::size_t>((n + kListGrain - 1) / kListGrain));
  pool->For(0, n, kListGrain, [&](std::int64_t first, std::int64_t last) {
    NearLists& lists = chunks_[static_cast<std::size_t>(first / kListGrain)];
    lists.Clear();
    auto next = static_cast<std::uint32_t>(first);
    const auto end = static_cast<std::uint32_t>(last);
    while (next < end) next = ListNear(grid, bodies, listed_, kernel, next, end, &lists);
  });
}

template <typename T>
void VerletLists<T>::Save(StateWriter* out) const {
  out->Put(listed_);
  out->Put(static_cast<std::uint64_t>(x_.size()));
  for (const std::vector<T>* column : {&x_, &y_, &z_}) out->Put(*column);
}

template <typename T>
void VerletLists<T>::Load(StateReader* in) {
  in->Take(&listed_);
  std::uint64_t size = 0;
  in->Take(&size);
  for (std::vector<T>* column : {&x_, &y_, &z_}) {
    column->resize(size);
    in->Take(column);
  }
  loaded_ = true;
}

template class VerletLists<float>;
template class VerletLists<double>;

}  // namespace flocklift
