// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What stands around the animals all through a film: solid obstacles (matte, light grey), goals
// (translucent green balls, with a ring), paths (red lines), a grid on the ground, and surfaces
// that move, such as a flock of tetrahedra. At a frame it makes the setting that the renderer
// takes.

#ifndef FLOCKLIFT_SIMULATE_RENDER_SCENERY_H_
#define FLOCKLIFT_SIMULATE_RENDER_SCENERY_H_

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "simulate/core/scene.h"
#include "simulate/core/triangle_mesh.h"
#include "simulate/core/vec3.h"
#include "simulate/media/draw.h"
#include "simulate/render/marks.h"
#include "simulate/render/renderer.h"

namespace flocklift {

inline constexpr Color kObstacleColor{196, 200, 202};
inline constexpr Color kGoalColor{70, 170, 60};
inline constexpr Color kPathColor{50, 60, 220};
inline constexpr Color kGroundColor{90, 90, 90};

// A surface whose vertices are other ones in each frame.
struct MovingSurface {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Color> tones;  // one for all, or one for each triangle
  bool is_closed = false;    // as in Surface
  // Fills the vertices of a frame (world, m) and, for motion blur, their velocities [m/s]; these
  // may stay empty. Called from several threads at once.
  std::function<void(int frame, std::vector<Vec3d>* vertices, std::vector<Vec3d>* velocities)> at;
};

// `count` tetrahedra, four vertices each one after the other.
MovingSurface MovingTetrahedra(std::size_t count, Color tone, decltype(MovingSurface::at) at);

class Scenery {
 public:
  void AddObstacle(TriangleMesh mesh);
  // `center_at` gives the place at a time [s].
  void AddGoal(std::function<Vec3d(double time)> center_at, double radius);
  // A line through points close enough to look smooth [m].
  void AddPath(std::vector<Vec3d> points);
  // A grid of metres (or of 10, 100 ... m where there would be more than 60 lines) at z = low.z,
  // or of 0.1, 0.01 ... m where there would be fewer than 6.
  void AddGround(const Region& region);
  void AddSurface(MovingSurface surface);

  bool empty() const {
    return solids_.empty() && goals_.empty() && strokes_.empty() && moving_.empty();
  }

  // Whether what hides animals is elsewhere in another frame.
  bool SurfacesMove() const { return !moving_.empty(); }

  // Calls `use(setting)` with what stands there in a frame.
  void With(int frame, double time, const std::function<void(const Setting&)>& use) const;
  // Only what hides animals: obstacles and surfaces.
  void WithSurfaces(int frame, const std::function<void(std::span<const Surface>)>& use) const;

 private:
  struct Solid {
    TriangleMesh mesh;
    std::vector<Vec3d> normals;
  };
  struct Goal {
    std::function<Vec3d(double)> center_at;
    double radius;
  };
  std::vector<Solid> solids_;
  std::vector<Goal> goals_;
  std::vector<Stroke> strokes_;
  std::vector<MovingSurface> moving_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_SCENERY_H_
