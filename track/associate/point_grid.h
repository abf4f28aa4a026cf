// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points in square cells, for all points within a distance.

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_POINT_GRID_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_POINT_GRID_H_

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

class PointGrid {
 public:
  // `cell` is the side of a cell [px], about the usual distance asked for.
  PointGrid(std::span<const Vec2d> points, double cell) : points_(points), cell_(cell) {
    if (points.empty()) return;
    double right = points[0].x, bottom = points[0].y;
    left_ = points[0].x;
    top_ = points[0].y;
    for (const Vec2d& p : points) {
      left_ = std::min(left_, p.x);
      right = std::max(right, p.x);
      top_ = std::min(top_, p.y);
      bottom = std::max(bottom, p.y);
    }
    // No more than some cells a point: far outliers widen the cells.
    const double most = 4.0 * static_cast<double>(points.size()) + 16;
    cell_ = std::max(cell_, std::sqrt((right - left_ + 1) * (bottom - top_ + 1) / most));
    columns_ = static_cast<int>((right - left_) / cell_) + 1;
    rows_ = static_cast<int>((bottom - top_) / cell_) + 1;
    first_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
    for (const Vec2d& p : points) ++first_[CellOf(p) + 1];
    for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
    members_.resize(points.size());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (std::size_t k = 0; k < points.size(); ++k) {
      members_[next[CellOf(points[k])]++] = static_cast<int>(k);
    }
  }

  // Calls take(index, squared distance) for the points within `radius`.
  template <typename Take>
  void ForEachWithin(const Vec2d& p, double radius, const Take& take) const {
    if (points_.empty()) return;
    const int i0 = Cell(p.x - radius - left_, columns_), i1 = Cell(p.x + radius - left_, columns_);
    const int j0 = Cell(p.y - radius - top_, rows_), j1 = Cell(p.y + radius - top_, rows_);
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        const std::size_t cell = static_cast<std::size_t>(j) * columns_ + i;
        for (int k = first_[cell]; k < first_[cell + 1]; ++k) {
          const Vec2d& q = points_[members_[k]];
          const double dx = q.x - p.x, dy = q.y - p.y, distance2 = dx * dx + dy * dy;
          if (distance2 <= radius * radius) take(members_[k], distance2);
        }
      }
    }
  }

 private:
  int Cell(double offset, int count) const {
    return static_cast<int>(std::clamp(std::floor(offset / cell_), 0.0, count - 1.0));
  }
  std::size_t CellOf(const Vec2d& p) const {
    return static_cast<std::size_t>(Cell(p.y - top_, rows_)) * columns_ +
           Cell(p.x - left_, columns_);
  }

  std::span<const Vec2d> points_;
  double cell_ = 1, left_ = 0, top_ = 0;
  int columns_ = 0, rows_ = 0;
  std::vector<int> first_, members_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_POINT_GRID_H_
