// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A solid of tetrahedra that is being edited: edges and faces split, edges collapse, and it stays
// conforming. A collapse is allowed when link(u) n link(v) = link(uv), with a point at infinity
// behind the boundary (Dey, Edelsbrunner, Guha, Nekhayev, Publ. Inst. Math. 66, 1999).

#ifndef FLOCKLIFT_SIMULATE_SHAPES_TETRA_COMPLEX_H_
#define FLOCKLIFT_SIMULATE_SHAPES_TETRA_COMPLEX_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simulate/shapes/tetra_mesh.h"

namespace flocklift {

class TetraComplex {
 public:
  explicit TetraComplex(TetraMesh mesh);

  const std::vector<Vec3d>& vertices() const { return mesh_.vertices; }
  std::span<const std::uint32_t> TetrahedraAt(std::uint32_t vertex) const {
    return around_[vertex];
  }
  const std::array<std::uint32_t, 4>& Tetrahedron(std::uint32_t tetra) const {
    return mesh_.tetrahedra[tetra];
  }
  std::size_t slots() const { return mesh_.tetrahedra.size(); }  // collapsed ones included
  bool Alive(std::uint32_t tetra) const { return alive_[tetra]; }
  Tetra Corners(std::uint32_t tetra) const { return mesh_.Corners(tetra); }

  void Move(std::uint32_t vertex, const Vec3d& to) { mesh_.vertices[vertex] = to; }
  double WorstQualityAt(std::uint32_t vertex) const;

  // Both return the new vertex, in the middle.
  std::uint32_t SplitEdge(std::uint32_t a, std::uint32_t b);
  std::uint32_t SplitBoundaryFace(const std::array<std::uint32_t, 3>& face);

  // Whether u may become v without harm to the topology.
  bool CanCollapse(std::uint32_t u, std::uint32_t v) const;
  // The worst quality of the tetrahedra that u would hand to v.
  double WorstAfterCollapse(std::uint32_t u, std::uint32_t v) const;
  void Collapse(std::uint32_t u, std::uint32_t v);

  TriangleMesh BoundaryFaces() const;
  TetraMesh Finish() const;  // without unused vertices

 private:
  bool Has(std::uint32_t tetra, std::uint32_t vertex) const;
  std::uint32_t AddVertex(const Vec3d& p);
  void AddTetra(const std::array<std::uint32_t, 4>& corners);
  TetraMesh Living() const;

  TetraMesh mesh_;
  std::vector<bool> alive_;
  std::vector<std::vector<std::uint32_t>> around_;  // the living tetrahedra of each vertex
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_TETRA_COMPLEX_H_
