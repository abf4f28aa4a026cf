// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A tree of bounding boxes over a surface's triangles: the point nearest to a given one, and where
// a segment first meets the surface. Logarithmic in triangles; answers do not depend on the tree
// (equally near triangles: the one with the smaller index).

#ifndef FLOCKLIFT_SIMULATE_SHAPES_TRIANGLE_TREE_H_
#define FLOCKLIFT_SIMULATE_SHAPES_TRIANGLE_TREE_H_

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "simulate/core/triangle_mesh.h"

namespace flocklift {

// The point of triangle abc that is nearest to p.
Vec3d NearestOnTriangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

class TriangleTree {
 public:
  // Keeps a copy. Throws std::invalid_argument for a surface without triangles.
  explicit TriangleTree(TriangleMesh surface);

  struct Nearest {
    std::uint32_t triangle = 0;
    Vec3d point;
    double squared_distance = std::numeric_limits<double>::infinity();  // [m^2]
  };
  Nearest NearestPoint(const Vec3d& p) const;

  // The smallest s in [0, 1] for which from + s (to - from) lies on a triangle.
  std::optional<double> FirstHit(const Vec3d& from, const Vec3d& to) const;

  const TriangleMesh& surface() const { return surface_; }

 private:
  struct Node {
    Vec3d low, high;
    std::uint32_t first = 0, last = 0;  // range of order_; inner nodes: children at first, last
    bool leaf = false;
  };
  std::uint32_t Build(std::uint32_t first, std::uint32_t last);

  TriangleMesh surface_;
  std::vector<std::uint32_t> order_;
  std::vector<Vec3d> centroid_;
  std::vector<Node> nodes_;
  std::uint32_t root_ = 0;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_TRIANGLE_TREE_H_
