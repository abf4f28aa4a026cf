// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Strokes that a person drew: over a picture they become 2D tracks, in space the way of a goal.

#ifndef FLOCKLIFT_TOOLS_VIEW_SKETCH_H_
#define FLOCKLIFT_TOOLS_VIEW_SKETCH_H_

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/vec3.h"

namespace flocklift {

// `count` points along a line of at least two points, the first and last included, at equal
// distances along it. A line without length gives its first point `count` times.
std::vector<Vec3d> EvenlyAlong(std::span<const Vec3d> line, int count);

// One stroke over the picture [px], flown along at constant speed from frame `first` to `last`.
struct Stroke {
  int first = 1, last = 2;
  std::vector<Vec2d> points;
};

// {"strokes": [{"first": .., "last": .., "points": [[x, y], ..]}, ..]}: checked. Throws
// std::invalid_argument.
std::vector<Stroke> StrokesOf(const nlohmann::ordered_json& json);

// Tracks with ids 1, 2, .. in the order of the strokes, whose boxes have `size` px.
Tracks TracksOfStrokes(std::span<const Stroke> strokes, double size);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_SKETCH_H_
