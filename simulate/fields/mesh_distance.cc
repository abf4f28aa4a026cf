// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/fields/surface_fault.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kLeafTriangles = 3;
constexpr int kDeepest = 64;  // of the tree, which halves its triangles at every level

double Axis(const Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

void Enclose(const Vec3d& point, Vec3d* low, Vec3d* high) {
  *low = {std::min(low->x, point.x), std::min(low->y, point.y), std::min(low->z, point.z)};
  *high = {std::max(high->x, point.x), std::max(high->y, point.y), std::max(high->z, point.z)};
}

double SquaredDistanceToBox(const Vec3d& p, const Vec3d& low, const Vec3d& high) {
  const double x = std::max(std::max(low.x - p.x, p.x - high.x), 0.0);
  const double y = std::max(std::max(low.y - p.y, p.y - high.y), 0.0);
  const double z = std::max(std::max(low.z - p.z, p.z - high.z), 0.0);
  return x * x + y * y + z * z;
}

// Where on the segment from 0 to `side` the nearest point to `p` lies: 0 .. 1.
double AlongSegment(const Vec3d& p, const Vec3d& side) {
  return std::clamp(Dot(p, side) / SquaredNorm(side), 0.0, 1.0);
}

double SquaredDistanceToSegment(const Vec3d& p, const Vec3d& side) {
  return SquaredNorm(p - AlongSegment(p, side) * side);
}

}  // namespace

// The nearest point lies inside the triangle, or on a side that the point's projection is beyond:
// with one barycentric coordinate negative on the side opposite, with two on either of two.
double MeshDistance::Face::SquaredDistance(const Vec3d& point, double best) const {
  const Vec3d p = point - a;
  const double height = Dot(p, normal);
  double nearest = std::numeric_limits<double>::infinity();
  if (height * height >= best) return nearest;
  const double along_ab = Dot(p, ab), along_ac = Dot(p, ac);
  const double s = (ac_ac * along_ab - ab_ac * along_ac) * inverse_det;  // weight of b
  const double t = (ab_ab * along_ac - ab_ac * along_ab) * inverse_det;  // weight of c
  if (s >= 0 && t >= 0 && s + t <= 1) return height * height;
  if (t < 0) nearest = SquaredDistanceToSegment(p, ab);
  if (s < 0) nearest = std::min(nearest, SquaredDistanceToSegment(p, ac));
  if (s + t > 1) nearest = std::min(nearest, SquaredDistanceToSegment(p - ab, ac - ab));
  return nearest;
}

MeshDistance::MeshDistance(const TriangleMesh& mesh) {
  const auto fault = SurfaceFault(mesh);
  Check(!fault, "a signed distance needs a closed surface: " + fault.value_or(""));
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<Vec3d> centres(count);
  faces_.resize(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    Face& face = faces_[t];
    face.a = mesh.Corner(t, 0);
    face.ab = mesh.Corner(t, 1) - face.a;
    face.ac = mesh.Corner(t, 2) - face.a;
    const Vec3d area = Cross(face.ab, face.ac);
    face.normal = area / Norm(area);
    face.ab_ab = SquaredNorm(face.ab);
    face.ab_ac = Dot(face.ab, face.ac);
    face.ac_ac = SquaredNorm(face.ac);
    face.inverse_det = 1 / SquaredNorm(area);
    face.triangle = t;
    centres[t] = face.a + (face.ab + face.ac) / 3.0;
  }

  FindRims(mesh);
  nodes_.reserve(2 * (count / 2) + 1);
  nodes_.push_back({{}, {}, 0, count});
  Split(0, &centres);
  slot_.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) slot_[faces_[k].triangle] = k;
}

// The two sides of every edge are found by sorting. They join the corners at their ends to the ring
// of triangles round a vertex; a vertex where surfaces touch has several rings.
void MeshDistance::FindRims(const TriangleMesh& mesh) {
  const auto corners = static_cast<std::uint32_t>(3 * mesh.triangles.size());
  const auto vertex = [&mesh](std::uint32_t corner) {
    return mesh.triangles[corner / 3][corner % 3];
  };
  const auto next = [](std::uint32_t corner) { return corner - corner % 3 + (corner + 1) % 3; };
  std::vector<std::pair<std::array<std::uint32_t, 2>, std::uint32_t>> sides;
  for (std::uint32_t c = 0; c < corners; ++c) {
    const std::uint32_t from = vertex(c), to = vertex(next(c));
    sides.push_back({{std::min(from, to), std::max(from, to)}, c});
  }
  std::sort(sides.begin(), sides.end());

  rims_.resize(mesh.triangles.size());
  std::vector<std::uint32_t> ring(corners);  // a corner farther on; the last of a ring itself
  std::iota(ring.begin(), ring.end(), 0U);
  const auto last = [&ring](std::uint32_t corner) {
    while (ring[corner] != corner) corner = ring[corner] = ring[ring[corner]];
    return corner;
  };
  for (std::size_t k = 0; k < sides.size(); k += 2) {
    const std::uint32_t one = sides[k].second, two = sides[k + 1].second;
    rims_[one / 3].side[one % 3] = rims_[two / 3].side[two % 3] =
        faces_[one / 3].normal + faces_[two / 3].normal;
    ring[last(one)] = last(next(two));
    ring[last(next(one))] = last(two);
  }

  std::vector<Vec3d> normals(corners);  // of a ring, at its last corner
  for (std::uint32_t c = 0; c < corners; ++c) {
    const Vec3d& here = mesh.vertices[vertex(c)];
    const Vec3d u = mesh.vertices[vertex(next(c))] - here;
    const Vec3d v = mesh.vertices[vertex(next(next(c)))] - here;
    normals[last(c)] += std::atan2(Norm(Cross(u, v)), Dot(u, v)) * faces_[c / 3].normal;
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> rings;  // vertex, last corner
  for (std::uint32_t c = 0; c < corners; ++c) {
    rims_[c / 3].corner[c % 3] = normals[last(c)];
    if (last(c) == c) rings.emplace_back(vertex(c), c);
  }
  std::sort(rings.begin(), rings.end());
  for (std::uint32_t c = 0; c < corners; ++c) {
    for (auto other = std::lower_bound(rings.begin(), rings.end(), std::pair{vertex(c), 0U});
         other != rings.end() && other->first == vertex(c); ++other) {
      if (other->second != last(c)) touching_.emplace_back(c, normals[other->second]);
    }
  }
}

// Halves a node's triangles along the longest side of their centres' box, until few are left.
void MeshDistance::Split(std::uint32_t index, std::vector<Vec3d>* centres) {
  const std::uint32_t first = nodes_[index].first, count = nodes_[index].count;
  Vec3d low = faces_[first].a, high = low;
  Vec3d centre_low = (*centres)[faces_[first].triangle], centre_high = centre_low;
  for (std::uint32_t k = first; k < first + count; ++k) {
    const Face& face = faces_[k];
    for (const Vec3d& corner : {face.a, face.a + face.ab, face.a + face.ac}) {
      Enclose(corner, &low, &high);
    }
    Enclose((*centres)[face.triangle], &centre_low, &centre_high);
  }
  nodes_[index].low = low;
  nodes_[index].high = high;
  if (count <= kLeafTriangles) return;
  const Vec3d extent = centre_high - centre_low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  std::nth_element(faces_.begin() + first, faces_.begin() + first + half,
                   faces_.begin() + first + count, [&](const Face& a, const Face& b) {
                     const double one = Axis((*centres)[a.triangle], axis);
                     const double two = Axis((*centres)[b.triangle], axis);
                     return one != two ? one < two : a.triangle < b.triangle;
                   });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, {}, first, half});
  nodes_.push_back({{}, {}, first + half, count - half});
  nodes_[index].first = child;
  nodes_[index].count = 0;
  Split(child, centres);
  Split(child + 1, centres);
}

SurfacePoint MeshDistance::Closest(const Vec3d& point, std::uint32_t hint) const {
  FLOCKLIFT_DCHECK(hint < slot_.size());
  const Face* nearest = &faces_[slot_[hint]];
  double best = nearest->SquaredDistance(point, std::numeric_limits<double>::infinity());
  struct Entry {
    std::uint32_t node;
    double squared;
  };
  std::array<Entry, kDeepest> stack;
  int top = 0;
  Entry at{0, 0};
  for (;;) {
    const Node& node = nodes_[at.node];
    if (node.count > 0) {
      for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
        const double squared = faces_[k].SquaredDistance(point, best);
        if (squared < best) {
          best = squared;
          nearest = &faces_[k];
        }
      }
    } else {
      Entry near{node.first,
                 SquaredDistanceToBox(point, nodes_[node.first].low, nodes_[node.first].high)};
      Entry far{node.first + 1, SquaredDistanceToBox(point, nodes_[node.first + 1].low,
                                                     nodes_[node.first + 1].high)};
      if (far.squared < near.squared) std::swap(near, far);
      if (far.squared < best) stack[top++] = far;
      if (near.squared < best) {
        at = near;
        continue;
      }
    }
    do {
      if (top == 0) return Resolve(point, *nearest);
      at = stack[--top];
    } while (!(at.squared < best));
  }
}

// The normal of a vertex for a point `away` from it: of the surface that the triangle belongs to,
// or of one that touches it there and has the point inside.
Vec3d MeshDistance::CornerNormal(std::uint32_t triangle, std::size_t corner,
                                 const Vec3d& away) const {
  const auto at = static_cast<std::uint32_t>(3 * triangle + corner);
  const auto first = std::lower_bound(
      touching_.begin(), touching_.end(), at,
      [](const auto& other, std::uint32_t number) { return other.first < number; });
  for (auto other = first; other != touching_.end() && other->first == at; ++other) {
    if (Dot(other->second, away) < 0) return other->second;
  }
  return rims_[triangle].corner[corner];
}

// Distance, foot and normal for the triangle that is known to be nearest.
SurfacePoint MeshDistance::Resolve(const Vec3d& point, const Face& face) const {
  SurfacePoint result;
  result.triangle = face.triangle;
  const Vec3d p = point - face.a;
  const double along_ab = Dot(p, face.ab), along_ac = Dot(p, face.ac);
  const double s = (face.ac_ac * along_ab - face.ab_ac * along_ac) * face.inverse_det;
  const double t = (face.ab_ab * along_ac - face.ab_ac * along_ab) * face.inverse_det;
  if (s >= 0 && t >= 0 && s + t <= 1) {
    result.distance = Dot(p, face.normal);
    result.position = point - result.distance * face.normal;
    result.normal = face.normal;
    return result;
  }
  const std::array<Vec3d, 3> corner = {Vec3d{}, face.ab, face.ac};
  const std::array<bool, 3> beyond = {t<0, s + t> 1, s < 0};  // side k starts at corner k
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    if (!beyond[k]) continue;
    const std::size_t next = (k + 1) % 3;
    const Vec3d side = corner[next] - corner[k];
    const double along = AlongSegment(p - corner[k], side);
    const Vec3d foot = corner[k] + along * side;
    const double squared = SquaredNorm(p - foot);
    if (squared >= best) continue;
    best = squared;
    result.position = face.a + foot;
    result.normal = along <= 0   ? CornerNormal(face.triangle, k, p - foot)
                    : along >= 1 ? CornerNormal(face.triangle, next, p - foot)
                                 : rims_[face.triangle].side[k];
  }
  result.normal = Normalized(result.normal);
  result.distance = std::copysign(std::sqrt(best), Dot(result.normal, point - result.position));
  return result;
}

}  // namespace flocklift
