// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Marks in space that help to read a picture: lines of a constant width in the image and
// translucent balls, anti-aliased, hidden by what is nearer than they are. A line is cut into
// pieces a few pixels long, each at its own depth; where pieces of one line meet in a pixel their
// shares add up to one share, so that a line shows no beads.

#ifndef FLOCKLIFT_SIMULATE_RENDER_MARKS_H_
#define FLOCKLIFT_SIMULATE_RENDER_MARKS_H_

#include <span>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/scene.h"
#include "simulate/core/vec3.h"
#include "simulate/media/draw.h"
#include "simulate/render/canvas.h"
#include "simulate/render/coverage.h"

namespace flocklift {

struct Stroke {
  std::vector<Vec3d> points;  // world [m]
  Color color;
  double width_px = 1.5;
  double opacity = 1;
};

// Seen as the disc inside its outline, at the depth of its outline.
struct TintedBall {
  Vec3d center;  // world [m]
  double radius = 1;
  Color color;
  double opacity = 0.25;
};

// The lines x = const and y = const at height z = region.low.z, `spacing` [m] apart, from corner to
// corner of the region.
std::vector<Stroke> GroundGrid(const Region& region, double spacing, Color color, double opacity);

// A circle about `center` across `axis`.
Stroke Ring(const Vec3d& center, double radius, const Vec3d& axis, Color color, double width_px,
            double opacity);

// The twelve edges of a box.
std::vector<Stroke> BoxEdges(const Region& box, Color color, double width_px, double opacity);

// Something ready to be laid over a canvas.
struct Patch {
  CoverageMask mask;
  Paint paint;
};

// The shares that one line has covered so far, of each pixel; zero between lines.
using LineCover = std::vector<float>;

// Appends the pieces, from far to near. Without haze give 0.
void AddStroke(const Stroke& stroke, const Camera& camera, const Rigid3d& cam_from_world,
               double haze, LineCover* cover, std::vector<Patch>* patches);
// Nothing when the camera is inside the ball, or the ball reaches behind the camera.
void AddBall(const TintedBall& ball, const Camera& camera, const Rigid3d& cam_from_world,
             double haze, std::vector<Patch>* patches);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_MARKS_H_
