// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/verlet_lists.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simulate/flock/extent.h"

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
ExtentPack<T> PackAt(const Moves<T>& moves, std::size_t k) {
  return flocklift::PackAt(moves.now, k) - flocklift::PackAt(moves.then, k);
}

// The bounding box of vectors.
template <typename T>
struct Box {
  std::array<Extent<T>, 3> axes;

  bool Finite() const { return axes[0].finite && axes[1].finite && axes[2].finite; }
  Vec3<T> Middle() const {
    const auto middle = [this](int axis) { return T(0.5) * (axes[axis].low + axes[axis].high); };
    return {middle(0), middle(1), middle(2)};
  }
  // No vector is farther from the middle; infinite where one is no finite number.
  double HalfDiagonal() const {
    double squared = 0;
    for (const Extent<T>& axis : axes) {
      const double half = 0.5 * (static_cast<double>(axis.high) - static_cast<double>(axis.low));
      squared += half * half;
    }
    return Finite() ? std::sqrt(squared) : std::numeric_limits<double>::infinity();
  }
};

std::size_t Chunk(std::int64_t first) { return static_cast<std::size_t>(first / kListGrain); }

// Of n > 0 vectors; also(first, last) is called on the way, once for each chunk of kListGrain.
template <typename T, typename Column, typename Also>
Box<T> BoxOf(const Column (&v)[3], std::size_t n, ThreadPool* pool, const Also& also) {
  const auto count = static_cast<std::int64_t>(n);
  std::vector<Box<T>> boxes(Chunk(count + kListGrain - 1));
  pool->For(0, count, kListGrain, [&](std::int64_t first, std::int64_t last) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      boxes[Chunk(first)].axes[axis] =
          ExtentOf<T>(v[axis], static_cast<std::size_t>(first), static_cast<std::size_t>(last));
    }
    also(static_cast<std::size_t>(first), static_cast<std::size_t>(last));
  });
  Box<T> all = boxes[0];
  for (const Box<T>& box : boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all.axes[axis] = Join(all.axes[axis], box.axes[axis]);
    }
  }
  return all;
}

// The largest distance of a vector from the middle of their box.
template <typename T, typename Column>
double Farthest(const Column (&v)[3], std::size_t n, const Box<T>& box, ThreadPool* pool) {
  if (!box.Finite()) return std::numeric_limits<double>::infinity();
  const auto count = static_cast<std::int64_t>(n);
  const Vec3<T> middle = box.Middle();
  std::vector<T> squares(Chunk(count + kListGrain - 1));
  pool->For(0, count, kListGrain, [&](std::int64_t first, std::int64_t last) {
    T most[kLanes] = {};
    const auto take = [&](std::size_t lane, std::size_t k) {
      const T x = v[0][k] - middle.x, y = v[1][k] - middle.y, z = v[2][k] - middle.z;
      const T squared = x * x + y * y + z * z;
      most[lane] = squared > most[lane] ? squared : most[lane];
    };
    auto k = static_cast<std::size_t>(first);
    const auto end = static_cast<std::size_t>(last);
    for (; k + kLanes <= end; k += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) take(lane, k + lane);
    }
    for (; k < end; ++k) take(0, k);
    squares[Chunk(first)] = *std::max_element(most, most + kLanes);
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
  MakeRoom(now.size(), &rows_);
  const Box<T> box = BoxOf<T>(moves, now.size(), pool, [&](std::size_t first, std::size_t last) {
    FillRows(now, first, last, &rows_);
  });
  const auto hold_after = [&](double farthest) {
    const double nearer = 2 * kMoveMargin * farthest;
    return reach.straight + nearer <= listed_.straight &&
           reach.manhattan + std::sqrt(3.0) * nearer <= listed_.manhattan;
  };
  // Mostly the box tells, which saves another pass.
  if (!hold_after(box.HalfDiagonal()) && !hold_after(Farthest(moves, now.size(), box, pool))) {
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
void VerletLists<T>::Reserve(const NearReach<T>& reach, double dt, const KernelVariant* kernel,
                             ThreadPool* pool, const Bodies<T>& now) {
  const std::size_t animals = now.size();
  if (kernel == nullptr || animals < kFewest || !ShouldLast(reach, dt, pool, now)) return;
  MakeRoom(animals, &rows_);
  for (std::vector<T>* column : {&x_, &y_, &z_}) {
    column->resize(animals + Bodies<T>::kPadding);
    column->clear();
  }
  MakeChunks(animals);
  pool->For(0, static_cast<std::int64_t>(chunks_.size()), 1, [&](std::int64_t chunk, std::int64_t) {
    chunks_[static_cast<std::size_t>(chunk)].Reserve();
  });
}

// For several steps, at the velocities of now.
template <typename T>
bool VerletLists<T>::ShouldLast(const NearReach<T>& reach, double dt, ThreadPool* pool,
                                const Bodies<T>& now) const {
  const T* const velocities[3] = {now.vx.data(), now.vy.data(), now.vz.data()};
  const Box<T> box = BoxOf<T>(velocities, now.size(), pool, [](std::size_t, std::size_t) {});
  const double nearer = 2 * dt * Farthest(velocities, now.size(), box, pool);  // in a step
  return kLeastSteps * nearer <= skin_ * reach.Farthest();
}

template <typename T>
void VerletLists<T>::MakeChunks(std::size_t animals) {
  const std::size_t chunks = Chunk(static_cast<std::int64_t>(animals) + kListGrain - 1);
  while (chunks_.size() < chunks) chunks_.emplace_back(&memory_);
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
    FillRows(herd->now, pool, &rows_);
  }
}

template <typename T>
bool VerletLists<T>::UpdateIfWorth(const NearReach<T>& reach, double dt,
                                   const KernelVariant* kernel, ThreadPool* pool, Herd<T>* herd) {
  if (herd->size() < kFewest) return false;
  if (!Hold(reach, kernel, pool, herd->now)) {
    listed_ = {T(-1), T(-1)};
    if (!ShouldLast(reach, dt, pool, herd->now)) return false;
    Renew(reach, pool, herd);
    if (MeanNeighbours(herd->grid, herd->size()) > kMostNeighbours) {
      listed_ = {T(-1), T(-1)};
      return false;
    }
    Make(kernel, pool, herd->grid, herd->now);
    FillRows(herd->now, pool, &rows_);
  }
  return true;
}

template <typename T>
void VerletLists<T>::Make(const KernelVariant* kernel, ThreadPool* pool, const CellGrid<T>& grid,
                          const Bodies<T>& bodies) {
  loaded_ = false;
  const auto n = static_cast<std::int64_t>(bodies.size());
  MakeChunks(bodies.size());
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
