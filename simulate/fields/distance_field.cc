// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/distance_field.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "simulate/core/parallel_for.h"

namespace flocklift {
namespace {

constexpr std::int64_t kRowsAtOnce = 16;

// A solid as it is met along a walk through the grid.
class Walker {
 public:
  explicit Walker(const Solid& solid) : solid_(&solid), mesh_(std::get_if<MeshDistance>(&solid)) {}

  // The smaller of `nearest` and the distance to the solid.
  double Nearer(const Vec3d& p, double nearest) {
    if (mesh_ == nullptr) return std::min(nearest, SignedDistance(*solid_, p));
    const double to_box = std::max(Bounds(*mesh_)(p), 0.0);
    if (to_box > 0 && to_box >= nearest) return nearest;
    const SurfacePoint closest = mesh_->Closest(p, hint_);
    hint_ = closest.triangle;
    return std::min(nearest, closest.distance);
  }

 private:
  const Solid* solid_;
  const MeshDistance* mesh_;
  std::uint32_t hint_ = 0;
};

}  // namespace

ScalarField DistanceField(const Grid& grid, std::span<const Solid> solids, int threads) {
  ScalarField field{grid, std::vector<float>(grid.size(), kNoObstacle)};
  const std::int64_t rows = static_cast<std::int64_t>(grid.ny) * grid.nz;
  ParallelFor(threads, 0, rows, kRowsAtOnce, [&](std::int64_t first, std::int64_t last) {
    std::vector<Walker> walkers(solids.begin(), solids.end());
    for (std::int64_t row = first; row < last; ++row) {
      const int j = static_cast<int>(row % grid.ny), k = static_cast<int>(row / grid.ny);
      for (int step = 0; step < grid.nx; ++step) {
        const int i = row % 2 == 0 ? step : grid.nx - 1 - step;  // to and fro
        const Vec3d p = grid.Node(i, j, k);
        double nearest = kNoObstacle;
        for (Walker& walker : walkers) nearest = walker.Nearer(p, nearest);
        field.values[grid.Index(i, j, k)] = static_cast<float>(nearest);
      }
    }
  });
  return field;
}

}  // namespace flocklift
