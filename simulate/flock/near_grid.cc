// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/near_grid.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "simulate/flock/kernels/swarm_kernel.h"

namespace flocklift {
namespace {

constexpr double kCellPerReach = 1.01;      // round-off
constexpr double kCellsPerAnimal = 2;       // at most
constexpr double kRimSlack = 0.01;          // cells; round-off
constexpr double kWide = 2;                 // reaches; cells up to here never hold too many
constexpr std::uint64_t kMostCompany = 12;  // animals in the cell of an animal, on average
constexpr std::size_t kPadding = 16;

// The four rows that follow a cell's own, relative to it.
struct Rows {
  std::uint32_t offset[4];
  Rows(int nx, int ny) {
    const auto row = static_cast<std::uint32_t>(nx + 2);
    const std::uint32_t layer = row * static_cast<std::uint32_t>(ny + 2);
    const std::uint32_t all[4] = {row, layer - row, layer, layer + row};
    std::copy_n(all, 4, offset);
  }
};

// 0 .. cells - 1; what is not a number is in the first.
template <typename T>
std::uint32_t Along(T u, T last) {
  const T kept = std::min(last, std::max(T(0), u));
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(kept));
}

}  // namespace

template <typename T>
bool NearGrid<T>::ChooseCells(const CrowdBox<T>& box, T reach) {
  const auto extent = [](T low, T high) {
    return static_cast<double>(high) - static_cast<double>(low);
  };
  const double x = extent(box.low.x, box.high.x), y = extent(box.low.y, box.high.y),
               z = extent(box.low.z, box.high.z);
  // Beyond this, places are too coarse for cells.
  const double limit = 2e4 * static_cast<double>(reach);
  if (!(x >= 0 && y >= 0 && z >= 0 && x < limit && y < limit && z < limit)) return false;
  const double least = kCellPerReach * static_cast<double>(reach);
  const double most_cells = kCellsPerAnimal * static_cast<double>(n_) + 64;
  double edge = std::max(least, std::cbrt(x * y * z / most_cells));
  const auto cells = [&edge](double length) { return std::floor(length / edge) + 1; };
  while (cells(x) * cells(y) * cells(z) > most_cells) edge *= 1.05;
  wide_ = edge > kWide * least;
  // In wide cells few are so far up that their company may be in the rows that follow; where many
  // are, asking takes longer than looking.
  rim_ = static_cast<T>(wide_ ? 1 - static_cast<double>(reach) / edge - kRimSlack : -1);
  low_ = box.low;
  per_cell_ = static_cast<T>(1 / edge);
  nx_ = static_cast<int>(cells(x));
  ny_ = static_cast<int>(cells(y));
  nz_ = static_cast<int>(cells(z));
  return true;
}

template <typename T>
void NearGrid<T>::NumberCells(std::span<const Crowd<T>> crowds, ThreadPool* pool) {
  cell_.resize(n_);
  std::uint32_t* to = cell_.data();
  const auto row = static_cast<std::uint32_t>(nx_ + 2);
  const std::uint32_t layer = row * static_cast<std::uint32_t>(ny_ + 2);
  const std::uint32_t corner = layer + row + 1;
  const T x1 = static_cast<T>(nx_ - 1), y1 = static_cast<T>(ny_ - 1), z1 = static_cast<T>(nz_ - 1);
  for (const Crowd<T>& crowd : crowds) {
    pool->For(
        0, static_cast<std::int64_t>(crowd.size), kCrowdGrain,
        [&, low = low_, per_cell = per_cell_, rim = rim_](std::int64_t first, std::int64_t last) {
          const T *const x = crowd.x, *const y = crowd.y, *const z = crowd.z;
          for (std::int64_t k = first; k < last; ++k) {
            const T v = (y[k] - low.y) * per_cell, w = (z[k] - low.z) * per_cell;
            const std::uint32_t b = Along(v, y1), c = Along(w, z1);
            const bool at_rim = v - static_cast<T>(static_cast<std::int32_t>(b)) > rim ||
                                w - static_cast<T>(static_cast<std::int32_t>(c)) > rim;
            to[k] = corner + Along((x[k] - low.x) * per_cell, x1) + b * row + c * layer +
                    (at_rim ? kNearAtRim : 0);
          }
        });
    to += crowd.size;
  }
}

// Ranks and runs; false if too many share a cell.
template <typename T>
bool NearGrid<T>::Count() {
  const std::size_t cells = static_cast<std::size_t>(nx_ + 2) * (ny_ + 2) * (nz_ + 2);
  start_.assign(cells + 1, 0);
  rank_.resize(n_);
  std::uint64_t company = 0;
  for (std::size_t k = 0; k < n_; ++k) {
    const std::uint32_t before = start_[cell_[k] & ~kNearAtRim]++;
    rank_[k] = before;
    company += before;
  }
  if (wide_ && company > kMostCompany / 2 * n_) return false;
  std::uint32_t sum = 0;
  for (std::uint32_t& start : start_) {
    const std::uint32_t count = start;
    start = sum;
    sum += count;
  }
  return true;
}

template <typename T>
bool NearGrid<T>::Sort(std::span<const Crowd<T>> crowds, const CrowdBox<T>& box, T reach,
                       ThreadPool* pool) {
  n_ = 0;
  for (const Crowd<T>& crowd : crowds) n_ += crowd.size;
  if (!ChooseCells(box, reach)) return false;
  NumberCells(crowds, pool);
  if (!Count()) return false;
  for (std::vector<T>* column : {&x_, &y_, &z_, &room_}) column->resize(n_ + kPadding);
  place_.resize(n_);
  animal_.resize(n_);
  std::size_t before = 0;
  for (const Crowd<T>& crowd : crowds) {
    pool->For(0, static_cast<std::int64_t>(crowd.size), kCrowdGrain,
              [&](std::int64_t first, std::int64_t last) {
                for (std::int64_t k = first; k < last; ++k) {
                  const std::size_t animal = before + static_cast<std::size_t>(k);
                  const std::uint32_t cell = cell_[animal],
                                      to = start_[cell & ~kNearAtRim] + rank_[animal];
                  x_[to] = crowd.x[k];
                  y_[to] = crowd.y[k];
                  z_[to] = crowd.z[k];
                  room_[to] = crowd.RoomOf(static_cast<std::size_t>(k));
                  place_[to] = cell;
                  animal_[to] = static_cast<std::uint32_t>(animal);
                }
              });
    before += crowd.size;
  }
  return true;
}

template <typename T>
void NearGrid<T>::AppendPairs(std::uint32_t first, std::vector<ClosePair<T>>* pairs) const {
  const auto look_through = [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t j = begin; j < end; ++j) {
      const Vec3<T> way{x_[j] - x_[first], y_[j] - y_[first], z_[j] - z_[first]};
      const T squared = way.x * way.x + way.y * way.y + way.z * way.z;
      const T distance = room_[first] + room_[j];
      if (squared < distance * distance) pairs->push_back({first, j, way, squared, distance});
    }
  };
  const std::uint32_t cell = place_[first] & ~kNearAtRim;
  look_through(first + 1, start_[cell + 2]);
  for (const std::uint32_t offset : Rows(nx_, ny_).offset) {
    look_through(start_[cell + offset - 1], start_[cell + offset + 2]);
  }
}

template <typename T>
void NearGrid<T>::FindPairs(ThreadPool* pool) {
  const std::size_t chunks = (n_ + kCrowdGrain - 1) / kCrowdGrain;
  has_.resize(chunks);
  pairs_.resize(chunks);
  pool->For(
      0, static_cast<std::int64_t>(n_), kCrowdGrain, [&](std::int64_t first, std::int64_t last) {
        const auto a = static_cast<std::uint32_t>(first), b = static_cast<std::uint32_t>(last);
        std::vector<ClosePair<T>>& pairs = pairs_[a / kCrowdGrain];
        pairs.clear();
        if constexpr (std::is_same_v<T, float>) {
          std::vector<std::uint32_t>& has = has_[a / kCrowdGrain];
          has.resize(kCrowdGrain);
          const Rows rows(nx_, ny_);
          const NearJob job{x_.data(),
                            y_.data(),
                            z_.data(),
                            room_.data(),
                            place_.data(),
                            start_.data(),
                            {rows.offset[0], rows.offset[1], rows.offset[2], rows.offset[3]}};
          const std::uint32_t count = FastestSwarmKernel().near(job, a, b, has.data());
          for (std::uint32_t k = 0; k < count; ++k) AppendPairs(has[k], &pairs);
        } else {
          for (std::uint32_t k = a; k < b; ++k) AppendPairs(k, &pairs);
        }
      });
}

template class NearGrid<float>;
template class NearGrid<double>;

}  // namespace flocklift
