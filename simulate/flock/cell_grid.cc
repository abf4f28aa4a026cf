// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flocklift {
namespace {

// More cells an axis, and the rounding of a coordinate would matter against kMargin.
constexpr int kMaxCellsPerAxis = 1024;
constexpr double kMargin = 1.001;

// Least value and width of a column, n >= 1. Eight at a time, so that it runs on packs. Throws
// std::runtime_error when a value is not finite.
template <typename T>
double Span(const std::vector<T>& column, std::size_t n, T* least) {
  constexpr std::size_t kLanes = 8;
  T low[kLanes], high[kLanes], zero[kLanes];
  std::fill_n(low, kLanes, column[0]);
  std::fill_n(high, kLanes, column[0]);
  std::fill_n(zero, kLanes, T(0));
  const auto take = [&](std::size_t lane, T value) {
    low[lane] = value < low[lane] ? value : low[lane];
    high[lane] = value > high[lane] ? value : high[lane];
    zero[lane] += value - value;  // 0, unless it is not finite
  };
  std::size_t k = 0;
  for (; k + kLanes <= n; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) take(lane, column[k + lane]);
  }
  for (; k < n; ++k) take(0, column[k]);
  if (!std::all_of(zero, zero + kLanes, [](T value) { return value == T(0); })) {
    throw std::runtime_error(
        "the simulation diverged (a position is not finite): take more substeps or smaller "
        "weights");
  }
  *least = *std::min_element(low, low + kLanes);
  return static_cast<double>(*std::max_element(high, high + kLanes)) - static_cast<double>(*least);
}

}  // namespace

template <typename T>
void CellGrid<T>::Sort(const Bodies<T>& from, double reach, Bodies<T>* to) {
  const std::size_t n = from.size();
  to->Resize(n);
  if (n == 0) {
    nx_ = ny_ = nz_ = 0;
    start_.assign(9, 0);
    return;
  }
  const double size_x = Span(from.x, n, &low_.x), size_y = Span(from.y, n, &low_.y),
               size_z = Span(from.z, n, &low_.z);

  const double longest = std::max({size_x, size_y, size_z});
  const double most_cells = 4.0 * static_cast<double>(n) + 64;
  double edge = std::max({kMargin * reach, longest / (kMaxCellsPerAxis - 1), 1e-30});
  const auto cells = [&edge](double size) { return static_cast<int>(size / edge) + 1; };
  while ((cells(size_x) + 2.0) * (cells(size_y) + 2.0) * (cells(size_z) + 2.0) > most_cells &&
         edge <= longest) {
    edge *= 1.25;
  }
  nx_ = cells(size_x);
  ny_ = cells(size_y);
  nz_ = cells(size_z);
  inverse_edge_ = static_cast<T>(1 / edge);

  const View g = view();
  const auto along = [this](T offset, int count) {
    const int k = static_cast<int>(offset * inverse_edge_);
    return 1 + (k < count ? k : count - 1);
  };
  cell_.resize(n);
  start_.assign(static_cast<std::size_t>(g.Cell(nx_ + 1, ny_ + 1, nz_ + 1)) + 2, 0);
  for (std::size_t k = 0; k < n; ++k) {
    const int cell = g.Cell(along(from.x[k] - low_.x, nx_), along(from.y[k] - low_.y, ny_),
                            along(from.z[k] - low_.z, nz_));
    cell_[k] = static_cast<std::uint32_t>(cell);
    ++start_[cell_[k] + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  // Filling moves each start to its end, which is the next one's start: shift back afterwards.
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t slot = start_[cell_[k]]++;
    to->x[slot] = from.x[k];
    to->y[slot] = from.y[k];
    to->z[slot] = from.z[k];
    to->vx[slot] = from.vx[k];
    to->vy[slot] = from.vy[k];
    to->vz[slot] = from.vz[k];
    to->agent[slot] = from.agent[k];
  }
  for (std::size_t c = start_.size() - 1; c > 0; --c) start_[c] = start_[c - 1];
  start_[0] = 0;
}

template class CellGrid<float>;
template class CellGrid<double>;

}  // namespace flocklift
