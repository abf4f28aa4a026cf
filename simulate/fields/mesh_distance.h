// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The exact signed distance of a point p to a closed triangle mesh:
//   phi(p) = s |p - c|,  c the point of the surface nearest to p,  s = sign(n . (p - c)),
// positive outside. n is the normal of what c lies on: of a face; of an edge, the sum of its two
// faces' normals; of a vertex, the sum over its faces of the normal times the angle there, which
// makes the sign right wherever c is. (Where surfaces touch at a vertex each has its own, and p is
// inside when it is so for any of them: solids that touch, not cavities.) J. A. Baerentzen, H.
// Aanaes, "Signed distance computation using the angle weighted pseudonormal", IEEE TVCG 11 (2005)
// 243-253. A tree of bounding boxes finds c: logarithmic in triangles near the surface.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_MESH_DISTANCE_H_
#define FLOCKLIFT_SIMULATE_FIELDS_MESH_DISTANCE_H_

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "simulate/core/triangle_mesh.h"

namespace flocklift {

// The point of a surface that is nearest to some point.
struct SurfacePoint {
  double distance = 0;  // signed, positive outside [m]
  Vec3d position;       // on the surface [m]
  Vec3d normal;         // the pseudo-normal there, a unit vector out of the solid
  std::uint32_t triangle = 0;
};

class MeshDistance {
 public:
  // Throws std::invalid_argument with what SurfaceFault says of a mesh that bounds no solid. Keeps
  // a copy of what it needs. Solids that overlap belong into a MeshDistance each: inside another
  // solid a surface says nothing about the inside of the union.
  explicit MeshDistance(const TriangleMesh& mesh);

  // `hint`, any triangle, speeds up the search when it is near (that of the point asked before).
  // Where several triangles are equally near, any of them is named.
  SurfacePoint Closest(const Vec3d& point, std::uint32_t hint = 0) const;

  // The signed distance alone.
  double operator()(const Vec3d& point) const { return Closest(point).distance; }

  // The box around the mesh [m].
  const Vec3d& low() const { return nodes_.front().low; }
  const Vec3d& high() const { return nodes_.front().high; }

 private:
  struct Node {
    Vec3d low, high;
    std::uint32_t first = 0;  // of its triangles, or of its two children, which are neighbours
    std::uint32_t count = 0;  // of its triangles; 0: an inner node
  };
  struct Face {
    Vec3d a, ab, ac, normal;  // corner, sides, unit normal
    double ab_ab, ab_ac, ac_ac, inverse_det;
    std::uint32_t triangle;
    // Or infinite where it is clear that it is not less than `best`.
    double SquaredDistance(const Vec3d& point, double best) const;
  };
  // Pseudo-normals of a triangle's corners and of the sides that start at them.
  struct Rim {
    std::array<Vec3d, 3> corner, side;
  };

  void Split(std::uint32_t node, std::vector<Vec3d>* centres);
  void FindRims(const TriangleMesh& mesh);
  Vec3d CornerNormal(std::uint32_t triangle, std::size_t corner, const Vec3d& away) const;
  SurfacePoint Resolve(const Vec3d& point, const Face& face) const;

  std::vector<Node> nodes_;
  std::vector<Face> faces_;          // by leaf
  std::vector<std::uint32_t> slot_;  // of a triangle in faces_
  std::vector<Rim> rims_;            // by triangle
  // Where surfaces touch: every corner there, as 3 triangle + corner, with another's normal.
  std::vector<std::pair<std::uint32_t, Vec3d>> touching_;  // sorted by corner
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_MESH_DISTANCE_H_
