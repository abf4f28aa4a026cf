// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Animals too small to have a shape in the image. What is left of a silhouette of a pixel or less
// is its area, so the exact outline is not built: the area seen from a direction is read from a
// table of the same solid (body.h), the frame's only cost then being a few pixels. With A the area
// across the line of sight [m^2], z the depth, theta the angle from the optical axis and J the
// Jacobian of the lens,
//   area in the image = A |det J| / (z^2 cos theta)   [px^2],
// spread evenly over the way of the animal while the shutter is open.
//
// The tables also hold the second moments and the half-widths of the silhouette, in the plane
// across the line of sight. With L the linear map from there to the image, a covariance C becomes
// L C L^T and the half-width along u that along L^T u: a box and a shape without an outline.

#ifndef FLOCKLIFT_SIMULATE_RENDER_SPECK_H_
#define FLOCKLIFT_SIMULATE_RENDER_SPECK_H_

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "simulate/render/body.h"

namespace flocklift {

// Areas of the solid seen from afar, from tables by direction, wingbeat phase and the ratio of body
// length to wingspan, made when first asked for. May be used from several threads at once.
class SpeckAreas {
 public:
  SpeckAreas();
  ~SpeckAreas();
  SpeckAreas(const SpeckAreas&) = delete;
  SpeckAreas& operator=(const SpeckAreas&) = delete;

  // [m^2], at `time` [s], from a viewer in direction `to_viewer` (unit vector, body frame). The
  // mean error is below 1 % of the area.
  double Area(const Animal& animal, double time, const Vec3d& to_viewer) const;

  // The silhouette about its centroid: x and y span the plane across the line of sight.
  struct Shadow {
    static constexpr int kDirections = 16;
    Vec3d x, y;                             // unit vectors, body frame
    double area;                            // [m^2]
    double xx, xy, yy;                      // second moments [m^2]
    std::array<double, kDirections> reach;  // half its extent along (cos a, sin a),
                                            // a = pi k / kDirections [m]

    // The same along any direction, times its length.
    double Reach(const Vec2d& direction) const;
  };
  Shadow Look(const Animal& animal, double time, const Vec3d& to_viewer) const;

 private:
  struct Table;
  struct Slot;
  struct Spot;
  static Spot Find(const Animal& animal, double time, const Vec3d& to_viewer);
  const Table& TableOf(int ratio) const;

  std::unique_ptr<std::vector<Slot>> slots_;
};

// A streak of the given area from one end of the animal's way to the other [px, px^2].
struct Speck {
  Vec2d from, to;
  double depth = 0;  // camera-frame z in the middle of the way [m]
  double area = 0;
};

// Wingspan and body length below this in the image make a speck [px].
inline constexpr double kSpeckPx = 1.5;
// Below this its box and moments are read from the tables, mean errors being within a hundredth of
// the size [px].
inline constexpr double kTablePx = 5;

// The larger of wingspan and body length at depth `depth`, about [px].
double SizePx(const Animal& animal, double depth, const Camera& camera);

// Nothing when the animal is not in the image, as for ProjectBody.
std::optional<Speck> ProjectSpeck(const FlyingAnimal& animal, double time, double shutter,
                                  const SpeckAreas& areas, const Camera& camera,
                                  const Rigid3d& cam_from_world);

// What the outline would be measured for: extent and moments, at a thirtieth of its cost.
struct SpeckBox {
  double half_width = 0, half_height = 0;  // [px]
  SilhouetteMoments moments;               // [px^2], about the projected position [px]
  double depth = 0;                        // [m]
};
std::optional<SpeckBox> ProjectSpeckBox(const FlyingAnimal& animal, double time,
                                        const SpeckAreas& areas, const Camera& camera,
                                        const Rigid3d& cam_from_world);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_SPECK_H_
