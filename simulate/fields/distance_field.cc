// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/distance_field.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "simulate/core/parallel_for.h"

namespace flocklift {
namespace {

constexpr int kBrick = 8;  // nodes along the edge of what one thread fills at once

// A box of nodes.
struct Brick {
  int i, j, k;  // its first node
  int end_i, end_j, end_k;

  Brick(const Grid& g, std::int64_t number) {
    const std::int64_t bricks_x = (g.nx + kBrick - 1) / kBrick;
    const std::int64_t bricks_y = (g.ny + kBrick - 1) / kBrick;
    i = static_cast<int>(number % bricks_x) * kBrick;
    j = static_cast<int>(number / bricks_x % bricks_y) * kBrick;
    k = static_cast<int>(number / bricks_x / bricks_y) * kBrick;
    end_i = std::min(i + kBrick, g.nx);
    end_j = std::min(j + kBrick, g.ny);
    end_k = std::min(k + kBrick, g.nz);
  }
  static std::int64_t Count(const Grid& g) {
    const auto bricks = [](int nodes) { return (nodes + kBrick - 1) / kBrick; };
    return static_cast<std::int64_t>(bricks(g.nx)) * bricks(g.ny) * bricks(g.nz);
  }
};

// A solid as it is met along a walk through the grid.
class Walker {
 public:
  explicit Walker(const Solid& solid)
      : solid_(&solid), mesh_(std::get_if<MeshDistance>(&solid)), bounds_(Bounds(solid)) {}

  // The solid is at least that far away, outside its bounds.
  double AtLeast(const Vec3d& p) const { return bounds_(p); }

  // The smaller of `nearest` and the distance to the solid.
  double Nearer(const Vec3d& p, double nearest) {
    if (mesh_ == nullptr) return std::min(nearest, SignedDistance(*solid_, p));
    const double at_least = AtLeast(p);
    if (at_least > 0 && at_least >= nearest) return nearest;
    const SurfacePoint closest = mesh_->Closest(p, hint_);
    hint_ = closest.triangle;
    return std::min(nearest, closest.distance);
  }

 private:
  const Solid* solid_;
  const MeshDistance* mesh_;
  Block bounds_;
  std::uint32_t hint_ = 0;
};

// Those that can be nearest somewhere in a ball: no distance changes by more than the way.
std::vector<Walker> Near(std::span<const Solid> solids, const Vec3d& centre, double radius) {
  std::vector<Walker> walkers(solids.begin(), solids.end());
  double nearest = kNoObstacle;
  for (Walker& walker : walkers) nearest = walker.Nearer(centre, nearest);
  std::erase_if(walkers, [&](const Walker& walker) {
    return walker.AtLeast(centre) > std::max(nearest + 2 * radius, radius);
  });
  // The nearest first: it spares the search in others.
  std::stable_sort(walkers.begin(), walkers.end(), [&](const Walker& a, const Walker& b) {
    return a.AtLeast(centre) < b.AtLeast(centre);
  });
  return walkers;
}

}  // namespace

ScalarField DistanceField(const Grid& grid, std::span<const Solid> solids, int threads) {
  ScalarField field{grid, std::vector<float>(grid.size(), kNoObstacle)};
  ParallelFor(threads, 0, Brick::Count(grid), 1, [&](std::int64_t number, std::int64_t /*end*/) {
    const Brick b(grid, number);
    const Vec3d low = grid.Node(b.i, b.j, b.k);
    const Vec3d high = grid.Node(b.end_i - 1, b.end_j - 1, b.end_k - 1);
    std::vector<Walker> walkers = Near(solids, 0.5 * (low + high), 0.5 * Norm(high - low));
    int i = b.i, step = 1;
    for (int k = b.k; k < b.end_k; ++k) {
      for (int j = b.j; j < b.end_j; ++j) {
        for (int count = b.i; count < b.end_i; ++count, i += step) {
          const Vec3d p = grid.Node(i, j, k);
          double nearest = kNoObstacle;
          for (Walker& walker : walkers) nearest = walker.Nearer(p, nearest);
          field.values[grid.Index(i, j, k)] = static_cast<float>(nearest);
        }
        step = -step;  // to and fro
        i += step;
      }
    }
  });
  return field;
}

}  // namespace flocklift
