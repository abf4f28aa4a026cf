// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/feature_lines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace flocklift {
namespace {

// Vertices by place: each vertex's first one at the same coordinates.
std::vector<std::uint32_t> FirstAtPlace(const std::vector<Vec3d>& vertices) {
  std::map<std::tuple<double, double, double>, std::uint32_t> places;
  std::vector<std::uint32_t> first;
  for (std::uint32_t k = 0; k < vertices.size(); ++k) {
    const Vec3d& p = vertices[k];
    first.push_back(places.try_emplace({p.x, p.y, p.z}, k).first->second);
  }
  return first;
}

class Unions {
 public:
  explicit Unions(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t Root(std::uint32_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void Join(std::uint32_t a, std::uint32_t b) {
    a = Root(a);
    b = Root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

Vec3d NearestOnSegment(const Vec3d& p, const Vec3d& from, const Vec3d& to) {
  const Vec3d way = to - from;
  const double length = SquaredNorm(way);
  const double s = length > 0 ? std::clamp(Dot(p - from, way) / length, 0.0, 1.0) : 0;
  return from + s * way;
}

FeatureLines FindFeatureLines(const TriangleMesh& surface, double crease_angle) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  const std::vector<std::uint32_t> first = FirstAtPlace(surface.vertices);
  std::map<Edge, std::vector<std::uint32_t>> sides;
  std::vector<Vec3d> normal;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    normal.push_back(Normalized(Cross(surface.Corner(t, 1) - surface.Corner(t, 0),
                                      surface.Corner(t, 2) - surface.Corner(t, 0))));
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = first[surface.triangles[t][e]];
      const std::uint32_t b = first[surface.triangles[t][(e + 1) % 3]];
      if (a != b) sides[std::minmax(a, b)].push_back(t);
    }
  }
  const double smooth = std::cos(crease_angle);
  Unions patches(surface.triangles.size());
  std::vector<std::pair<Edge, Edge>> creases;  // the edge and two triangles
  for (const auto& [edge, triangles] : sides) {
    const bool flat = triangles.size() == 2 &&
                      (Dot(normal[triangles[0]], normal[triangles[1]]) > smooth ||
                       normal[triangles[0]] == Vec3d{} || normal[triangles[1]] == Vec3d{});
    if (flat) {
      patches.Join(triangles[0], triangles[1]);
    } else {
      creases.push_back({edge, {triangles.front(), triangles.back()}});
    }
  }
  FeatureLines lines;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    lines.patch_of_triangle.push_back(patches.Root(t));
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> ends;  // neighbours along creases
  std::map<std::uint32_t, std::set<std::uint32_t>> patches_at;
  for (const auto& [edge, triangles] : creases) {
    const std::uint32_t p = lines.patch_of_triangle[triangles.first];
    const std::uint32_t q = lines.patch_of_triangle[triangles.second];
    lines.segments.push_back({surface.vertices[edge.first],
                              surface.vertices[edge.second],
                              {std::min(p, q), std::max(p, q)}});
    for (const auto& [here, there] : {edge, Edge{edge.second, edge.first}}) {
      ends[here].push_back(there);
      patches_at[here].insert({p, q});
    }
  }
  for (const auto& [vertex, others] : ends) {
    const Vec3d& p = surface.vertices[vertex];
    const bool goes_on =
        others.size() == 2 && Dot(Normalized(p - surface.vertices[others[0]]),
                                  Normalized(surface.vertices[others[1]] - p)) > smooth;
    if (goes_on) continue;
    const auto& touching = patches_at.at(vertex);
    lines.corners.push_back({p, {touching.begin(), touching.end()}});
  }
  return lines;
}

}  // namespace flocklift
