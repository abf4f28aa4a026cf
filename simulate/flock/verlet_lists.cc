// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/verlet_lists.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flocklift {
namespace {

constexpr double kMoveMargin = 1.001;   // against rounding
constexpr std::size_t kLanes = 8;       // taken together, which compilers know how to do
constexpr std::size_t kFewest = 512;    // animals, below which sorting takes no time
constexpr double kLeastSteps = 8;       // that lists must last to be worth their making
constexpr double kMostNeighbours = 96;  // on average, of lists that are

template <typename T>
struct Moves {
  const std::vector<T>&now, &then;
  T operator[](std::size_t k) const { return now[k] - then[k]; }
};

template <typename T>
struct Range {
  T low, high;
};

// The least and the greatest of first .. last - 1; over whole lanes first, the order does not
// count.
template <typename T, typename Column>
Range<T> RangeOf(const Column& values, std::size_t first, std::size_t last) {
  T low[kLanes], high[kLanes];
  std::fill(low, low + kLanes, values[first]);
  std::fill(high, high + kLanes, values[first]);
  const auto take = [&](std::size_t lane, T value) {
    low[lane] = value < low[lane] ? value : low[lane];
    high[lane] = value > high[lane] ? value : high[lane];
  };
  std::size_t k = first;
  for (; k + kLanes <= last; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) take(lane, values[k + lane]);
  }
  for (; k < last; ++k) take(0, values[k]);
  return {*std::min_element(low, low + kLanes), *std::max_element(high, high + kLanes)};
}

// The largest |v - middle|^2 of first .. last - 1; infinite where one is no finite number.
template <typename T, typename Column>
T FarthestSquared(const Column (&v)[3], const Vec3<T>& middle, std::size_t first,
                  std::size_t last) {
  T most[kLanes] = {}, sum[kLanes] = {};  // what is no number shows in the sum
  const auto take = [&](std::size_t lane, std::size_t k) {
    const T x = v[0][k] - middle.x, y = v[1][k] - middle.y, z = v[2][k] - middle.z;
    const T squared = x * x + y * y + z * z;
    most[lane] = squared > most[lane] ? squared : most[lane];
    sum[lane] += squared;
  };
  std::size_t k = first;
  for (; k + kLanes <= last; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) take(lane, k + lane);
  }
  for (; k < last; ++k) take(0, k);
  const bool finite =
      std::all_of(sum, sum + kLanes, [](const T& value) { return std::isfinite(value); });
  return finite ? *std::max_element(most, most + kLanes) : std::numeric_limits<T>::infinity();
}

// The largest distance from the middle of their bounding box; infinite where one is no finite
// number.
template <typename T, typename Column>
double Farthest(const Column (&v)[3], std::size_t n, ThreadPool* pool) {
  const auto chunk = [](std::int64_t first) {
    return static_cast<std::size_t>(first / kAgentGrain);
  };
  const auto count = static_cast<std::int64_t>(n);
  std::vector<std::array<Range<T>, 3>> ranges(chunk(count + kAgentGrain - 1));
  pool->For(0, count, kAgentGrain, [&](std::int64_t first, std::int64_t last) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ranges[chunk(first)][axis] =
          RangeOf<T>(v[axis], static_cast<std::size_t>(first), static_cast<std::size_t>(last));
    }
  });
  T middle[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Range<T> all = ranges[0][axis];
    for (const auto& range : ranges) {
      all.low = std::min(all.low, range[axis].low);
      all.high = std::max(all.high, range[axis].high);
    }
    middle[axis] = T(0.5) * (all.low + all.high);
  }
  std::vector<T> squares(ranges.size());
  pool->For(0, count, kAgentGrain, [&](std::int64_t first, std::int64_t last) {
    squares[chunk(first)] =
        FarthestSquared<T>(v, {middle[0], middle[1], middle[2]}, static_cast<std::size_t>(first),
                           static_cast<std::size_t>(last));
  });
  return std::sqrt(static_cast<double>(*std::max_element(squares.begin(), squares.end())));
}

// How many neighbours within the reach of a sorted grid there are on average, if the animals of
// every 27 cells are spread evenly.
template <typename T>
double MeanNeighbours(const CellGrid<T>& grid, std::size_t animals) {
  constexpr double kBall = 4.0 / 3 * 3.14159265 / 27;  // of the cells
  const auto g = grid.view();
  double pairs = 0;
  for (int row = 0; row < g.RowCount(); ++row) {
    const int b = 1 + row % g.ny, c = 1 + row / g.ny;
    for (int a = 1; a <= g.nx; ++a) {
      const int cell = g.Cell(a, b, c);
      const std::uint32_t own = g.start[cell + 1] - g.start[cell];
      if (own == 0) continue;
      std::uint32_t around = 0;
      CellGrid<T>::ForEachRun(
          g, a, a, b, c, [&](std::uint32_t first, std::uint32_t last) { around += last - first; });
      pairs += static_cast<double>(own) * around;
    }
  }
  return kBall * pairs / static_cast<double>(animals);
}

}  // namespace

template <typename T>
bool VerletLists<T>::Hold(const NearReach<T>& reach, const KernelVariant* kernel, ThreadPool* pool,
                          const Bodies<T>& now) {
  if (listed_.straight < reach.straight || listed_.manhattan < reach.manhattan) return false;
  const Moves<T> moves[3] = {{now.x, x_}, {now.y, y_}, {now.z, z_}};
  const double nearer = 2 * kMoveMargin * Farthest<T>(moves, now.size(), pool);
  if (reach.straight + nearer > listed_.straight ||
      reach.manhattan + std::sqrt(3.0) * nearer > listed_.manhattan) {
    return false;
  }
  if (loaded_) {  // as they were made, in the order that is there already
    Bodies<T> then = now, sorted;
    then.x = x_;
    then.y = y_;
    then.z = z_;
    CellGrid<T> grid;
    grid.Sort(then, listed_.Farthest(), &sorted, pool);
    Make(kernel, pool, grid, sorted);
  }
  return true;
}

template <typename T>
void VerletLists<T>::Renew(const NearReach<T>& reach, ThreadPool* pool, Herd<T>* herd) {
  const double skin = skin_ * reach.Farthest();
  listed_ = {static_cast<T>(reach.straight + skin),
             static_cast<T>(reach.manhattan + std::sqrt(3.0) * skin)};
  herd->SortBy(listed_.Farthest(), pool);
  x_ = herd->now.x;
  y_ = herd->now.y;
  z_ = herd->now.z;
}

template <typename T>
void VerletLists<T>::Update(const NearReach<T>& reach, const KernelVariant* kernel,
                            ThreadPool* pool, Herd<T>* herd) {
  if (herd->size() == 0) return;
  if (!Hold(reach, kernel, pool, herd->now)) {
    Renew(reach, pool, herd);
    Make(kernel, pool, herd->grid, herd->now);
  }
  FillRows(herd->now, pool, &rows_);
}

template <typename T>
bool VerletLists<T>::UpdateIfWorth(const NearReach<T>& reach, double dt,
                                   const KernelVariant* kernel, ThreadPool* pool, Herd<T>* herd) {
  if (herd->size() < kFewest) return false;
  if (!Hold(reach, kernel, pool, herd->now)) {
    listed_ = {T(-1), T(-1)};
    const Bodies<T>& now = herd->now;
    const T* const velocities[3] = {now.vx.data(), now.vy.data(), now.vz.data()};
    const double nearer = 2 * dt * Farthest<T>(velocities, now.size(), pool);  // in a step
    if (!(kLeastSteps * nearer <= skin_ * reach.Farthest())) return false;
    Renew(reach, pool, herd);
    if (MeanNeighbours(herd->grid, herd->size()) > kMostNeighbours) {
      listed_ = {T(-1), T(-1)};
      return false;
    }
    Make(kernel, pool, herd->grid, herd->now);
  }
  FillRows(herd->now, pool, &rows_);
  return true;
}

template <typename T>
void VerletLists<T>::Make(const KernelVariant* kernel, ThreadPool* pool, const CellGrid<T>& grid,
                          const Bodies<T>& bodies) {
  loaded_ = false;
  const auto n = static_cast<std::int64_t>(bodies.size());
  const auto chunks = static_cast<std::size_t>((n + kListGrain - 1) / kListGrain);
  while (chunks_.size() < chunks) chunks_.emplace_back(&memory_);
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
