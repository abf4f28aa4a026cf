// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/near_lists.h"

#include <type_traits>

#include "simulate/core/scratch.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kEight = 8;      // lists side by side
constexpr std::size_t kRowsAhead = 48;   // written
constexpr float kReachMargin = 1.0001F;  // of the kernels' boxes, against rounding
constexpr double kFarAway = 1e9;         // [m]

template <typename T>
void ListOne(const typename CellGrid<T>::View& g, const Bodies<T>& s, const NearReach<T>& reach,
             int b, int c, std::uint32_t k, std::vector<std::uint32_t>* list) {
  list->clear();
  const int a = g.CellX(s.x[k]);
  CellGrid<T>::ForEachRun(g, a, a, b, c, [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t j = first; j < last; ++j) {
      if (j != k && reach.Holds(s.Position(j) - s.Position(k))) list->push_back(j);
    }
  });
}

template <typename T>
void ListScalar(const CellGrid<T>& grid, const Bodies<T>& s, const NearReach<T>& reach,
                std::uint32_t first, std::uint32_t last, NearLists* lists) {
  const auto g = grid.view();
  const auto nobody = static_cast<std::uint32_t>(s.size());
  lists->places.resize(std::size_t{kEight} * lists->begin.back());
  std::vector<std::uint32_t> list;
  for (int row = 0; row < g.RowCount(); ++row) {
    const int b = 1 + row % g.ny, c = 1 + row / g.ny;
    const std::uint32_t from = std::max(first, g.start[g.Cell(1, b, c)]);
    const std::uint32_t to = std::min(last, g.start[g.Cell(g.nx, b, c) + 1]);
    for (std::uint32_t k = from; k < to; ++k) {
      const std::uint32_t lane = (k - first) % kEight;
      if (lane == 0) lists->begin.push_back(lists->begin.back());
      ListOne(g, s, reach, b, c, k, &list);
      const std::size_t begin = *(lists->begin.end() - 2);
      std::uint32_t& end = lists->begin.back();
      end = std::max(end, static_cast<std::uint32_t>(begin + list.size()));
      lists->places.resize(std::size_t{kEight} * end, nobody);
      for (std::size_t n = 0; n < list.size(); ++n) {
        lists->places[kEight * (begin + n) + lane] = list[n];
      }
    }
  }
}

// Goes on as long as there is room.
std::uint32_t ListByKernel(const CellGrid<float>& grid, const Bodies<float>& s,
                           const NearReach<float>& reach, const KernelVariant& kernel,
                           std::uint32_t first, std::uint32_t last, NearLists* lists) {
  thread_local Scratch<std::uint32_t> candidates, near;
  thread_local Scratch<float> columns;
  const std::size_t room = s.size() + 32;
  const auto g = grid.view();
  ListJob job{};
  job.pairs.start = g.start;
  job.pairs.low_x = g.low_x;
  job.pairs.inverse_edge = g.inverse_edge;
  job.pairs.nx = g.nx;
  job.pairs.ny = g.ny;
  job.pairs.nz = g.nz;
  job.pairs.x = s.x.data();
  job.pairs.y = s.y.data();
  job.pairs.z = s.z.data();
  job.straight = reach.straight;
  job.manhattan = reach.manhattan;
  job.margin = kReachMargin;
  job.nobody = static_cast<std::uint32_t>(s.size());
  job.candidates = candidates.Reserve(room);
  job.near = near.Reserve(room);
  job.columns = columns.Reserve(3 * room);
  job.column = room;
  const auto eights = [first](std::uint32_t end) { return (end - first + kEight - 1) / kEight; };
  const std::size_t listed = lists->begin.size();
  lists->begin.resize(listed + eights(last));
  job.begin = lists->begin.data() + (listed - 1);
  job.places = lists->places.data();
  job.room = lists->places.size();
  const std::uint32_t next = kernel.list(job, first, last);
  lists->begin.resize(listed + eights(next));
  if (next < last) lists->places.resize(2 * lists->places.size() + NearLists::kFirstRoom);
  return next;
}

}  // namespace

template <typename T>
std::uint32_t ListNear(const CellGrid<T>& grid, const Bodies<T>& bodies, const NearReach<T>& reach,
                       const KernelVariant* kernel, std::uint32_t first, std::uint32_t last,
                       NearLists* lists) {
  if constexpr (std::is_same_v<T, float>) {
    if (kernel != nullptr) {
      return ListByKernel(grid, bodies, reach, *kernel, first, last, lists);
    }
  }
  ListScalar(grid, bodies, reach, first, last, lists);
  return last;
}

template <typename T>
void MakeRoom(std::size_t n, std::vector<BodyRow<T>>* rows) {
  rows->resize(n);
  rows->resize(n + kEight, {T(kFarAway), T(kFarAway), T(kFarAway), T(0), T(0), T(0), T(0), T(0)});
}

// The rows that other threads have read since must be taken from their caches again, one after the
// other: so they are asked for ahead, to be written. (What compilers have for it they only use
// where a processor is named; one that does not know the instruction passes over it.)
template <typename T>
void FillRows(const Bodies<T>& bodies, std::size_t first, std::size_t last,
              std::vector<BodyRow<T>>* rows) {
  for (std::size_t k = first; k < last; ++k) {
    asm volatile("prefetchw %0" : : "m"((*rows)[std::min(k + kRowsAhead, last)].x));
    (*rows)[k] = {bodies.x[k],  bodies.y[k],  bodies.z[k],  T(0),
                  bodies.vx[k], bodies.vy[k], bodies.vz[k], T(0)};
  }
}

template <typename T>
void FillRows(const Bodies<T>& bodies, ThreadPool* pool, std::vector<BodyRow<T>>* rows) {
  MakeRoom(bodies.size(), rows);
  pool->For(0, static_cast<std::int64_t>(bodies.size()), kListGrain,
            [&](std::int64_t first, std::int64_t last) {
              FillRows(bodies, static_cast<std::size_t>(first), static_cast<std::size_t>(last),
                       rows);
            });
}

template std::uint32_t ListNear(const CellGrid<float>&, const Bodies<float>&,
                                const NearReach<float>&, const KernelVariant*, std::uint32_t,
                                std::uint32_t, NearLists*);
template std::uint32_t ListNear(const CellGrid<double>&, const Bodies<double>&,
                                const NearReach<double>&, const KernelVariant*, std::uint32_t,
                                std::uint32_t, NearLists*);
template void MakeRoom(std::size_t, std::vector<BodyRow<float>>*);
template void FillRows(const Bodies<float>&, std::size_t, std::size_t,
                       std::vector<BodyRow<float>>*);
template void FillRows(const Bodies<float>&, ThreadPool*, std::vector<BodyRow<float>>*);
template void MakeRoom(std::size_t, std::vector<BodyRow<double>>*);
template void FillRows(const Bodies<double>&, std::size_t, std::size_t,
                       std::vector<BodyRow<double>>*);
template void FillRows(const Bodies<double>&, ThreadPool*, std::vector<BodyRow<double>>*);

}  // namespace flocklift
