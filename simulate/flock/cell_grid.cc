// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulate/flock/extent.h"

namespace flocklift {
namespace {

// More cells an axis, and the rounding of a coordinate would matter against kMargin.
constexpr int kMaxCellsPerAxis = 1024;
constexpr double kMargin = 1.001;

// Animals, below which another thread is not worth waking.
constexpr std::size_t kLeastChunk = 2048, kLeastBoxChunk = 32768;
constexpr std::uint32_t kBlockBits = 12;  // of a cell's number within a block of work

// n animals in equal shares for `count` threads.
struct Shares {
  std::size_t n;
  int count;

  std::size_t First(int k) const {
    return n * static_cast<std::size_t>(k) / static_cast<std::size_t>(count);
  }
  // Calls fn(k, first, last) for each share.
  template <typename Function>
  void ForEach(ThreadPool* pool, const Function& fn) const {
    const auto run = [&](std::int64_t k, std::int64_t) {
      fn(static_cast<std::size_t>(k), First(static_cast<int>(k)), First(static_cast<int>(k) + 1));
    };
    if (count == 1) return run(0, 1);
    pool->For(0, count, 1, run);
  }
};

// Of x, y and z.
template <typename T>
struct Box {
  Extent<T> x, y, z;
};

// Throws std::runtime_error when a position is not finite.
template <typename T>
Box<T> BoxOf(const Bodies<T>& bodies, const Shares& shares, ThreadPool* pool) {
  std::vector<Box<T>> of(static_cast<std::size_t>(shares.count));
  shares.ForEach(pool, [&](std::size_t k, std::size_t first, std::size_t last) {
    of[k] = {ExtentOf<T>(bodies.x, first, last), ExtentOf<T>(bodies.y, first, last),
             ExtentOf<T>(bodies.z, first, last)};
  });
  Box<T> all = of[0];
  for (const Box<T>& box : of) {
    all = {Join(all.x, box.x), Join(all.y, box.y), Join(all.z, box.z)};
  }
  if (!(all.x.finite && all.y.finite && all.z.finite)) {
    throw std::runtime_error(
        "the simulation diverged (a position is not finite): take more substeps or smaller "
        "weights");
  }
  return all;
}

}  // namespace

template <typename T>
void CellGrid<T>::Sort(const Bodies<T>& from, double reach, Bodies<T>* to, ThreadPool* pool) {
  const std::size_t n = from.size();
  to->Resize(n);
  if (n == 0) {
    nx_ = ny_ = nz_ = 0;
    start_.assign(9, 0);
    return;
  }
  const auto most_shares = [&](std::size_t most) {
    const auto threads = static_cast<std::size_t>(pool != nullptr ? pool->threads() : 1);
    return Shares{n, static_cast<int>(std::max<std::size_t>(1, std::min(threads, most)))};
  };
  const Box<T> box = BoxOf(from, most_shares(n / kLeastBoxChunk), pool);
  ChooseCells({box.x.low, box.y.low, box.z.low}, {box.x.high, box.y.high, box.z.high}, reach, n);

  const View g = view();
  const auto along = [this](T offset, int count) {
    const int k = static_cast<int>(offset * inverse_edge_);
    return 1 + (k < count ? k : count - 1);
  };
  const std::size_t cells = static_cast<std::size_t>(g.Cell(nx_ + 1, ny_ + 1, nz_ + 1)) + 1;
  // Each share counts and fills by itself, and those of one cell follow each other in their order:
  // the sort is stable, so the order is the same however many shares there are.
  const Shares shares = most_shares(n / kLeastChunk);
  const std::size_t blocks = (cells >> kBlockBits) + 1;
  cell_.resize(n);
  start_.resize(cells + 1);
  next_.resize(cells * static_cast<std::size_t>(shares.count));
  in_block_.assign(blocks * static_cast<std::size_t>(shares.count), 0);
  shares.ForEach(pool, [&](std::size_t share, std::size_t first, std::size_t last) {
    std::uint32_t* const count = next_.data() + share * cells;
    std::uint32_t* const in_block = in_block_.data() + share * blocks;
    std::fill_n(count, cells, 0);
    for (std::size_t k = first; k < last; ++k) {
      const int cell = g.Cell(along(from.x[k] - low_.x, nx_), along(from.y[k] - low_.y, ny_),
                              along(from.z[k] - low_.z, nz_));
      cell_[k] = static_cast<std::uint32_t>(cell);
      ++count[cell];
      if (shares.count > 1) ++in_block[static_cast<std::uint32_t>(cell) >> kBlockBits];
    }
  });
  StartRuns(cells, shares.count > 1 ? pool : nullptr);
  shares.ForEach(pool, [&](std::size_t share, std::size_t first, std::size_t last) {
    std::uint32_t* const next = next_.data() + share * cells;
    for (std::size_t k = first; k < last; ++k) {
      const std::uint32_t slot = next[cell_[k]]++;
      to->x[slot] = from.x[k];
      to->y[slot] = from.y[k];
      to->z[slot] = from.z[k];
      to->vx[slot] = from.vx[k];
      to->vy[slot] = from.vy[k];
      to->vz[slot] = from.vz[k];
      to->agent[slot] = from.agent[k];
    }
  });
}

// Turns the counts of each share into where in the order it goes on, block by block of cells.
template <typename T>
void CellGrid<T>::StartRuns(std::size_t cells, ThreadPool* pool) {
  const auto start = [&](std::size_t first, std::size_t last, std::uint32_t sum) {
    for (std::size_t c = first; c < last; ++c) {
      start_[c] = sum;
      for (std::size_t share = c; share < next_.size(); share += cells) {
        const std::uint32_t count = next_[share];
        next_[share] = sum;
        sum += count;
      }
    }
  };
  start_[cells] = static_cast<std::uint32_t>(cell_.size());
  if (pool == nullptr) return start(0, cells, 0);
  const std::size_t blocks = (cells >> kBlockBits) + 1;
  std::uint32_t sum = 0;  // of the blocks before
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::uint32_t before = sum;
    for (std::size_t share = block; share < in_block_.size(); share += blocks) {
      sum += in_block_[share];
    }
    in_block_[block] = before;
  }
  pool->For(0, static_cast<std::int64_t>(cells), std::int64_t{1} << kBlockBits,
            [&](std::int64_t first, std::int64_t last) {
              start(static_cast<std::size_t>(first), static_cast<std::size_t>(last),
                    in_block_[static_cast<std::size_t>(first >> kBlockBits)]);
            });
}

template <typename T>
void CellGrid<T>::ChooseCells(const Vec3<T>& low, const Vec3<T>& high, double reach,
                              std::size_t n) {
  const auto size = [](T a, T b) { return static_cast<double>(b) - static_cast<double>(a); };
  const double size_x = size(low.x, high.x), size_y = size(low.y, high.y),
               size_z = size(low.z, high.z);
  const double longest = std::max({size_x, size_y, size_z});
  const double most_cells = 4.0 * static_cast<double>(n) + 64;
  double edge = std::max({kMargin * reach, longest / (kMaxCellsPerAxis - 1), 1e-30});
  const auto cells = [&edge](double along) { return static_cast<int>(along / edge) + 1; };
  while ((cells(size_x) + 2.0) * (cells(size_y) + 2.0) * (cells(size_z) + 2.0) > most_cells &&
         edge <= longest) {
    edge *= 1.25;
  }
  low_ = low;
  nx_ = cells(size_x);
  ny_ = cells(size_y);
  nz_ = cells(size_z);
  inverse_edge_ = static_cast<T>(1 / edge);
}

template class CellGrid<float>;
template class CellGrid<double>;

}  // namespace flocklift
