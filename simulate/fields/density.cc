// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/density.h"

namespace flocklift {

ScalarField DensityField(const Grid& grid, std::span<const Vec3d> positions) {
  ScalarField density{grid, std::vector<float>(grid.size(), 0.0F)};
  double volume = 1;  // of a cell
  for (const int nodes : {grid.nx, grid.ny, grid.nz}) volume *= nodes > 1 ? grid.spacing : 1;
  for (const Vec3d& position : positions) {
    const GridCell cell = CellOf(grid, position);
    cell.ForEachCorner([&](std::size_t node, double weight) {
      density.values[node] += static_cast<float>(weight / volume);
    });
  }
  return density;
}

}  // namespace flocklift
