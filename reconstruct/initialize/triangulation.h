// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where two cameras' rays meet.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_TRIANGULATION_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_TRIANGULATION_H_

#include <optional>

#include "reconstruct/initialize/segments.h"

namespace flocklift {

// The animal's ray at a time, linear between sightings; nothing outside its time or across a gap of
// more than half a second.
std::optional<Vec2d> RayAt(const Segment& segment, double time);

// How far the second camera's ray passes the plane of the first one's ray and both cameras, in
// normalised coordinates of the second: the distance from the epipolar line. Negative on its one
// side. Nothing where the rays run along the line from camera to camera.
std::optional<double> EpipolarDistance(const Vec2d& ray, const View& view);

// The depth [m] on the first camera's ray that comes nearest to the second one's. Nothing where the
// rays are parallel or meet behind a camera.
std::optional<double> TriangulatedDepth(const Vec2d& ray, const View& view);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_TRIANGULATION_H_
