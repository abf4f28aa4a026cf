// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The cheapest way to the goals: the minimum-cost field C and the direction of its descent,
//   |grad C| = A + B g(X) + extra(X),   C = 0 in the goals,   V = -grad C / |grad C|,
// g the repulsion of the obstacles (bell.h), walls where their signed distance is negative. X.
// Wang, X. Jin, Z. Deng, L. Zhou, "Inherent noise-aware insect swarm simulation", Computer Graphics
// Forum 33 (2014) 51-62, section 5, where `extra`, a cost of crowded places, is named as future
// work. One field serves the animals that share goals; species with goals of their own have one
// each.
//
// V is one-sided: along each axis it points to the smaller neighbour that C was computed from, or
// nowhere. So C falls strictly along every axis that V has a part of, from node to node down to a
// goal: no local minimum, and no two neighbours that point at each other.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_COST_FIELD_H_
#define FLOCKLIFT_SIMULATE_FIELDS_COST_FIELD_H_

#include <cstdint>
#include <span>
#include <vector>

#include "simulate/fields/bell.h"
#include "simulate/fields/eikonal.h"
#include "simulate/fields/grid_field.h"
#include "simulate/fields/solids.h"

namespace flocklift {

struct CostOptions {
  double length_weight = 0.6;       // A, cost of a metre, > 0
  double repulsion_weight = 0.4;    // B, cost of a metre along a surface, >= 0
  double diagonal = kCellDiagonal;  // a of the repulsion [spacings], which reaches 2 a far
};

// What a sampler reads of a node, in one load of 16 bytes. A kernel takes the eight corners of a
// cell (the grid's Index, x fastest, then y, z) and interpolates all four trilinearly.
struct alignas(16) GuideNode {
  float x = 0, y = 0, z = 0;  // V, a unit vector; 0 in goals and where no goal can be reached;
                              // in walls the way out
  float distance = 0;         // signed, to the obstacles [m]
};

class CostField {
 public:
  // `distance` to the obstacles [m]; its grid is the field's. A goal holds the nodes inside it, or
  // the nearest free node where there is none. `threads` changes nothing but the time. Throws
  // std::invalid_argument without goals.
  CostField(const ScalarField& distance, const CostOptions& options, std::span<const Solid> goals,
            int threads = 1);

  // What has been set holds where it is covered, and there the field is a new one's, to the bit.
  // The cost of every node changes with the only goal, and then only what is covered is computed
  // anew: a swarm close behind its goal asks for little. With one of several goals only its
  // surroundings change, and the rest stays covered.
  void SetGoals(std::span<const Solid> goals);
  // Cost by node in addition, >= 0 [per metre]; empty: none.
  void SetExtra(std::span<const float> extra);

  // Computes cost and guide of the nodes, and what is cheaper than they are.
  void Cover(std::span<const std::size_t> nodes);
  void CoverAll();
  bool covers_all() const { return covers_all_; }

  const Grid& grid() const { return distance_.grid; }
  const CostOptions& options() const { return options_; }
  // C of a covered node; infinite in walls and where no goal can be reached.
  float Cost(std::size_t node) const { return eikonal_.At(node); }
  bool IsWall(std::size_t node) const { return eikonal_.IsWall(node); }
  std::size_t unreachable() const;  // free nodes without a way to a goal

  const std::vector<GuideNode>& guide() const { return guide_; }

  // The direction to go: a unit vector; 0 inside a goal. The corners' directions, interpolated;
  // where they cancel (two ways equally good), the nearest node's.
  Vec3d Direction(const Vec3d& point) const;

 private:
  void SetSlowness(std::span<const float> extra);
  void SetSeeds();
  void Prepare();
  void Guide(std::size_t node);

  ScalarField distance_;
  CostOptions options_;
  std::vector<Solid> goals_;
  std::vector<float> slowness_;
  int threads_;
  Eikonal eikonal_;
  std::vector<GuideNode> guide_;
  std::vector<std::uint8_t> covered_;  // by node; counts where not all are
  bool covers_all_ = false;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_COST_FIELD_H_
