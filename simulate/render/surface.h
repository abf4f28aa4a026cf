// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of triangles as a camera sees them: matte, lit by the sun and the sky. With n the unit
// normal on the viewer's side, `up` against gravity and `sun` towards the sun,
//   shade = 0.35 + 0.25 (1 + n.up) / 2 + 0.5 max(0, n.sun),
// one for a triangle, or linear between its corners where normals are given. Both sides are drawn,
// so a mesh may be open, and its triangles may face any way, unless it says that it is closed.

#ifndef FLOCKLIFT_SIMULATE_RENDER_SURFACE_H_
#define FLOCKLIFT_SIMULATE_RENDER_SURFACE_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/vec3.h"
#include "simulate/media/draw.h"
#include "simulate/render/depth_buffer.h"

namespace flocklift {

// Views of what somebody else keeps.
struct Surface {
  std::span<const Vec3d> vertices;  // world [m]
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const Color> tones;       // one for all, or one for each triangle
  std::span<const Vec3d> normals;     // 3 for each triangle, world; empty: flat shading
  std::span<const Vec3d> velocities;  // of each vertex [m/s]; empty: it is at rest
  bool is_closed = false;  // faces seen from inside are hidden by others: they need no drawing
};

// The faces of `count` tetrahedra whose corners stand four by four in an array: 4 x count
// triangles that face outwards where (b - a) x (c - a) . (d - a) > 0.
std::vector<std::array<std::uint32_t, 3>> TetrahedraFaces(std::size_t count);

// Projects surfaces into a depth buffer: cut off at the near plane and at the rim of the view, and
// split where the lens bends their edges by more than a tenth of a pixel.
class SurfacePainter {
 public:
  explicit SurfacePainter(const Camera& camera);

  // The shutter is open for `shutter` seconds about the frame's time. Of a moving surface each of
  // the four samples of a pixel sees a moment of its own.
  void Draw(const Surface& surface, const Rigid3d& cam_from_world, double shutter,
            DepthBuffer* out) const;

  // Where light comes from, for a camera that knows gravity or does not.
  struct Light {
    Vec3d up, sun;  // unit vectors, world
  };
  double Shade(const Vec3d& normal) const;

 private:
  struct Corner;
  void DrawMoment(const Surface& surface, const Rigid3d& cam_from_world, double offset,
                  unsigned samples, DepthBuffer* out) const;
  void DrawClipped(const std::array<Corner, 3>& corners, const std::array<std::uint8_t, 3>& tone,
                   unsigned samples, DepthBuffer* out) const;
  void DrawBent(const std::array<ImageCorner, 3>& corners, const std::array<std::uint8_t, 3>& tone,
                unsigned samples, int depth, DepthBuffer* out) const;
  bool IsFolded(const Vec2d& normalized) const;

  Camera camera_;
  Light light_;
  bool is_bent_;            // the lens distorts
  Vec2d low_, high_;        // normalised coordinates of all that the sensor sees
  double safe_radius_ = 0;  // no fold of the distortion within [normalised]
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_SURFACE_H_
