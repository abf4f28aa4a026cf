// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/tetra_complex.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kInfinity = ~0U;  // the point behind the boundary

using Simplex = std::vector<std::uint32_t>;  // ascending

// All simplices of the boundary of the triangle that a tetrahedron's link part is.
void AddWithFaces(Simplex simplex, std::set<Simplex>* set) {
  std::sort(simplex.begin(), simplex.end());
  if (!set->insert(simplex).second || simplex.size() == 1) return;
  for (std::size_t k = 0; k < simplex.size(); ++k) {
    Simplex face = simplex;
    face.erase(face.begin() + static_cast<std::ptrdiff_t>(k));
    AddWithFaces(face, set);
  }
}

// The tetrahedra of a vertex, those with the point at infinity included, each without the vertex.
std::vector<Simplex> Star(const TetraComplex& complex, std::uint32_t u) {
  std::vector<Simplex> star;
  std::map<Simplex, int> faces;
  for (const std::uint32_t t : complex.TetrahedraAt(u)) {
    Simplex others;
    for (const std::uint32_t v : complex.Tetrahedron(t)) {
      if (v != u) others.push_back(v);
    }
    std::sort(others.begin(), others.end());
    for (std::size_t k = 0; k < 3; ++k) {
      Simplex face = others;
      face.erase(face.begin() + static_cast<std::ptrdiff_t>(k));
      ++faces[face];
    }
    star.push_back(std::move(others));
  }
  for (const auto& [face, count] : faces) {
    if (count == 1) star.push_back({face[0], face[1], kInfinity});
  }
  return star;
}

}  // namespace

TetraComplex::TetraComplex(TetraMesh mesh)
    : mesh_(std::move(mesh)),
      alive_(mesh_.tetrahedra.size(), true),
      around_(mesh_.vertices.size()) {
  for (std::uint32_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
    for (const std::uint32_t v : mesh_.tetrahedra[t]) around_[v].push_back(t);
  }
}

bool TetraComplex::Has(std::uint32_t tetra, std::uint32_t vertex) const {
  const auto& corners = mesh_.tetrahedra[tetra];
  return std::find(corners.begin(), corners.end(), vertex) != corners.end();
}

std::uint32_t TetraComplex::AddVertex(const Vec3d& p) {
  mesh_.vertices.push_back(p);
  around_.emplace_back();
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void TetraComplex::AddTetra(const std::array<std::uint32_t, 4>& corners) {
  const auto t = static_cast<std::uint32_t>(mesh_.tetrahedra.size());
  mesh_.tetrahedra.push_back(corners);
  alive_.push_back(true);
  for (const std::uint32_t v : corners) around_[v].push_back(t);
}

double TetraComplex::WorstQualityAt(std::uint32_t vertex) const {
  double worst = 1;
  for (const std::uint32_t t : around_[vertex]) worst = std::min(worst, ShapeQuality(Corners(t)));
  return worst;
}

std::uint32_t TetraComplex::SplitEdge(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t v = AddVertex(0.5 * (mesh_.vertices[a] + mesh_.vertices[b]));
  const std::vector<std::uint32_t> ring = around_[a];
  for (const std::uint32_t t : ring) {
    if (!Has(t, b)) continue;
    auto other = mesh_.tetrahedra[t];
    std::replace(mesh_.tetrahedra[t].begin(), mesh_.tetrahedra[t].end(), b, v);
    std::erase(around_[b], t);
    around_[v].push_back(t);
    std::replace(other.begin(), other.end(), a, v);
    AddTetra(other);
  }
  return v;
}

std::uint32_t TetraComplex::SplitBoundaryFace(const std::array<std::uint32_t, 3>& face) {
  const auto& ring = around_[face[0]];
  const auto owner = std::find_if(ring.begin(), ring.end(), [&](std::uint32_t t) {
    return Has(t, face[1]) && Has(t, face[2]);
  });
  FLOCKLIFT_DCHECK(owner != ring.end());
  const std::uint32_t t = *owner;
  const std::uint32_t v = AddVertex(
      (mesh_.vertices[face[0]] + mesh_.vertices[face[1]] + mesh_.vertices[face[2]]) / 3.0);
  const auto corners = mesh_.tetrahedra[t];
  for (std::size_t k = 0; k < 3; ++k) {
    auto piece = corners;
    std::replace(piece.begin(), piece.end(), face[k], v);
    if (k > 0) {
      AddTetra(piece);
      continue;
    }
    mesh_.tetrahedra[t] = piece;
    std::erase(around_[face[0]], t);
    around_[v].push_back(t);
  }
  return v;
}

bool TetraComplex::CanCollapse(std::uint32_t u, std::uint32_t v) const {
  std::set<Simplex> link_u, link_v, link_uv;
  for (const Simplex& s : Star(*this, u)) {
    AddWithFaces(s, &link_u);
    if (std::find(s.begin(), s.end(), v) == s.end()) continue;
    Simplex edge = s;
    std::erase(edge, v);
    AddWithFaces(edge, &link_uv);
  }
  for (const Simplex& s : Star(*this, v)) AddWithFaces(s, &link_v);
  if (link_uv.empty()) return false;  // no edge
  return std::all_of(link_u.begin(), link_u.end(),
                     [&](const Simplex& s) { return !link_v.contains(s) || link_uv.contains(s); });
}

double TetraComplex::WorstAfterCollapse(std::uint32_t u, std::uint32_t v) const {
  double worst = 1;
  for (const std::uint32_t t : around_[u]) {
    if (Has(t, v)) continue;
    Tetra corners = Corners(t);
    for (std::size_t k = 0; k < 4; ++k) {
      if (mesh_.tetrahedra[t][k] == u) corners[k] = mesh_.vertices[v];
    }
    worst = std::min(worst, ShapeQuality(corners));
  }
  return worst;
}

void TetraComplex::Collapse(std::uint32_t u, std::uint32_t v) {
  const std::vector<std::uint32_t> ring = std::move(around_[u]);
  around_[u].clear();
  for (const std::uint32_t t : ring) {
    if (Has(t, v)) {
      alive_[t] = false;
      for (const std::uint32_t w : mesh_.tetrahedra[t]) std::erase(around_[w], t);
    } else {
      std::replace(mesh_.tetrahedra[t].begin(), mesh_.tetrahedra[t].end(), u, v);
      around_[v].push_back(t);
    }
  }
}

TetraMesh TetraComplex::Living() const {
  TetraMesh living{mesh_.vertices, {}};
  for (std::size_t t = 0; t < alive_.size(); ++t) {
    if (alive_[t]) living.tetrahedra.push_back(mesh_.tetrahedra[t]);
  }
  return living;
}

TriangleMesh TetraComplex::BoundaryFaces() const { return Boundary(Living()); }

TetraMesh TetraComplex::Finish() const {
  TetraMesh result = Living();
  std::vector<std::uint32_t> name(mesh_.vertices.size());
  result.vertices.clear();
  for (std::size_t v = 0; v < name.size(); ++v) {
    name[v] = static_cast<std::uint32_t>(result.vertices.size());
    if (!around_[v].empty()) result.vertices.push_back(mesh_.vertices[v]);
  }
  for (auto& t : result.tetrahedra) {
    for (std::uint32_t& v : t) v = name[v];
  }
  return result;
}

}  // namespace flocklift
