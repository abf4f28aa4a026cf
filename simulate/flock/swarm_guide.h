// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What leads a noise-aware swarm: the distance to the walls and the way to the goals, on one grid
// over the scene's box (simulate/fields/cost_field.h), and both in the cells that the swarm's
// kernel reads (simulate/flock/kernels/swarm_kernel.h). The box counts as a wall seen from within;
// one cell beyond it still belongs to the grid and leads back inside.
//
// Where there is one goal and the straight line to it is clear of all repulsion, that line is the
// cheapest way: such a cell points along it, and no front needs to march there.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SWARM_GUIDE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SWARM_GUIDE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simulate/fields/cost_field.h"
#include "simulate/fields/grid_field.h"
#include "simulate/flock/bodies.h"
#include "simulate/flock/kernels/swarm_kernel.h"
#include "simulate/flock/world.h"

namespace flocklift {

class GuideField {
 public:
  // `spacing` of the grid [m]. Without goals there are only the walls. Throws std::invalid_argument
  // when the world has no box.
  GuideField(const World& world, double spacing, const CostOptions& options,
             std::span<const GoalSpec> goals, int threads);

  // Goals that have moved, as many as before. From then on the guide holds where it is covered.
  void SetGoals(std::span<const GoalSpec> goals);
  // A further cost by node [per metre]; likewise.
  void SetExtra(std::span<const float> extra);
  // Makes it hold where the animals are: of the way to the goals only what is nearer is found.
  template <typename T>
  void Cover(const Bodies<T>& animals);

  const Grid& grid() const { return distance_.grid; }
  const ScalarField& distance() const { return distance_; }
  // For a kernel; valid until the next change. Distances are told up to WallReach().
  SwarmGuide View(double speed) const;
  double WallReach() const { return 2 * grid().spacing; }

 private:
  void Unpack();
  bool Sees(std::size_t cell) const;
  void PackAll();
  void PackCell(std::size_t cell);
  GridPlace Place(std::size_t cell) const;
  std::array<std::size_t, 8> Corners(std::size_t cell) const;

  ScalarField distance_;
  CostOptions options_;
  std::vector<Ball> goals_;
  bool crowded_ = false;  // places have further costs
  std::optional<CostField> cost_;
  int threads_;
  std::vector<std::int8_t> cells_;    // with room to begin on a cache line
  std::vector<std::uint8_t> packed_;  // by cell; empty: all of them
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SWARM_GUIDE_H_
