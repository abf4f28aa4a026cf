// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Who is near whom, by the engine's grid of cells: the walk that the terms of a fit share.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_NEAR_ANIMALS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_NEAR_ANIMALS_H_

#include <cstdint>
#include <span>

#include "simulate/core/vec3.h"
#include "simulate/flock/cell_grid.h"

namespace flocklift::internal {

// visit(animal, others) for each animal, by cells; others(fn) calls fn(animal, dx, velocity) for
// each other within `reach` (above 0) of it, dx from the one to the other.
template <typename Visit>
void ForEachAnimal(std::span<const Vec3d> x, std::span<const Vec3d> v, double reach,
                   const Visit& visit) {
  Bodies<double> unsorted, sorted;
  unsorted.Resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    unsorted.Set(i, x[i], v[i]);
    unsorted.agent[i] = static_cast<std::uint32_t>(i);
  }
  CellGrid<double> grid;
  grid.Sort(unsorted, reach, &sorted);
  const auto view = grid.view();
  for (int row = 0; row < view.RowCount(); ++row) {
    const int b = 1 + row % view.ny, c = 1 + row / view.ny;
    for (int a = 1; a <= view.nx; ++a) {
      const std::uint32_t begin = view.start[view.Cell(a, b, c)];
      const std::uint32_t end = view.start[view.Cell(a, b, c) + 1];
      for (std::uint32_t i = begin; i < end; ++i) {
        visit(sorted.agent[i], [&](const auto& fn) {
          const Vec3d own = sorted.Position(i);
          CellGrid<double>::ForEachRun(view, a, a, b, c,
                                       [&](std::uint32_t first, std::uint32_t last) {
                                         for (std::uint32_t j = first; j < last; ++j) {
                                           const Vec3d dx = sorted.Position(j) - own;
                                           if (j == i || SquaredNorm(dx) > reach * reach) continue;
                                           fn(sorted.agent[j], dx, sorted.Velocity(j));
                                         }
                                       });
        });
      }
    }
  }
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_NEAR_ANIMALS_H_
