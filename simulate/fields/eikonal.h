// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The eikonal equation |grad C| = s on a grid, first order and upwind: at every node
//   C = min(seed, u),   sum over the axes of max(0, u - m)^2 = (s l)^2,
// m the smaller of the two neighbours' C along an axis. Solved by fast marching, that is about in
// the order of C: J. A. Sethian, "A fast marching level set method for monotonically advancing
// fronts", PNAS 93 (1996) 1591-1595.
//
// Rounded as it is, u is still larger than every m it was computed from, so the discrete equations
// have one solution, to the bit: whatever order leads to it, from nothing or from the solution of
// an earlier problem, the result is the same.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_EIKONAL_H_
#define FLOCKLIFT_SIMULATE_FIELDS_EIKONAL_H_

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "simulate/fields/cost_buckets.h"
#include "simulate/fields/grid_field.h"

namespace flocklift {

class Eikonal {
 public:
  static constexpr float kInfinite = std::numeric_limits<float>::infinity();

  // A node that knows an upper limit of its C: a source.
  struct Seed {
    std::size_t node = 0;  // Grid::Index
    float value = 0;       // >= 0
  };

  // All walls and no seed: C is infinite.
  explicit Eikonal(const Grid& grid);

  // `slowness` s by Grid::Index, > 0; infinite: a wall. Takes effect with the next Solve.
  void SetSlowness(std::span<const float> slowness);
  void SetSeeds(std::span<const Seed> seeds);

  // Solves what has been set. Only what changes with it is computed anew, as long as that is less
  // than a part of the grid; otherwise all of it.
  void Solve();

  // Likewise, but where all of the grid would be computed anew, nothing is yet: then C of a node is
  // right once Reach has been called for it. That computes only what is cheaper than the node, and
  // goes on where the last call stopped.
  void Prepare();
  void Reach(std::size_t node);
  void ReachAll();

  float At(std::size_t node) const { return value_[Padded(node)]; }
  bool IsWall(std::size_t node) const { return step_[Padded(node)] == kInfinite; }
  // C of the neighbours: before and after along x, y, z; infinite beyond the grid and in walls.
  std::array<float, 6> Neighbours(std::size_t node) const;

  // The nodes that the last Solve or Prepare may have changed, in any order; all of them when it
  // began anew.
  bool solved_all() const { return solved_all_; }
  const std::vector<std::size_t>& changed() const { return changed_; }

 private:
  // One layer of walls all around saves the tests at the rim.
  std::size_t Padded(std::size_t node) const {
    const std::size_t row = node / grid_.nx;
    return (row / grid_.ny + 1) * slice_ + (row % grid_.ny + 1) * row_ + node % grid_.nx + 1;
  }
  std::size_t Unpadded(std::size_t padded) const {
    return grid_.Index(static_cast<int>(padded % row_) - 1,
                       static_cast<int>(padded % slice_ / row_) - 1,
                       static_cast<int>(padded / slice_) - 1);
  }
  float Update(std::size_t padded) const;
  bool Raise();
  void Begin();
  void Local();
  template <typename Change>
  void Pop(const Change& change);

  Grid grid_;
  std::size_t row_, slice_, free_ = 0;
  std::array<std::ptrdiff_t, 6> offsets_;
  std::vector<float> value_, step_, seed_;  // padded; step = s l
  std::vector<std::uint32_t> seeded_;       // padded nodes that have a seed
  std::vector<std::uint32_t> edited_;       // whose equation changed since the last Solve
  std::vector<std::uint32_t> raised_;
  internal::CostBuckets front_;
  float width_ = 1;  // of its buckets
  std::vector<std::size_t> changed_;
  bool solved_all_ = true;
  bool complete_ = false;  // every node's equation holds
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_EIKONAL_H_
