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
  const auto span = [n](const std::vector<T>& column, T* low) {
    T high = *low = column[0];
    T finite(0);  // x - x is 0, unless x is not finite
    for (std::size_t k = 0; k < n; ++k) {
      *low = std::min(*low, column[k]);
      high = std::max(high, column[k]);
      finite += column[k] - column[k];
    }
    if (!(finite == 0)) {
      throw std::runtime_error(
          "the simulation diverged (a position is not finite): take more substeps or smaller "
          "weights");
    }
    return static_cast<double>(high) - static_cast<double>(*low);
  };
  const double size_x = span(from.x, &low_.x), size_y = span(from.y, &low_.y),
               size_z = span(from.z, &low_.z);

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
