// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a camera sees: detections, and the tracklets that data association makes of them. Pixels as
// in OpenCV: u right, v down, the centre of the top-left pixel at (0, 0). Frames count from 1.

#ifndef FLOCKLIFT_SIMULATE_CORE_OBSERVATIONS_H_
#define FLOCKLIFT_SIMULATE_CORE_OBSERVATIONS_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

// An animal's identity: positive, unique in a file. Detections without one carry kNoId.
using Id = std::int64_t;
inline constexpr Id kNoId = -1;

// An upright box [px]; its centre is the animal's image position.
struct Box {
  double left = 0, top = 0, width = 0, height = 0;

  Vec2d Center() const { return {left + 0.5 * width, top + 0.5 * height}; }
  static Box Around(const Vec2d& center, double width, double height) {
    return {center.x - 0.5 * width, center.y - 0.5 * height, width, height};
  }
};

// A blob's second moments: 4 standard deviations along its axes [px], angle of the major axis from
// +u towards +v in [0, 180) [deg], area [px^2].
struct Shape {
  double major = 0, minor = 0, angle_deg = 0, area = 0;
};

// One animal in one frame. Confidence is in [0, 1]; below 0.5 the row is interpolated.
struct Detection {
  int frame = 0;
  Box box;
  double confidence = 1;
  std::optional<Shape> shape;
  double visibility = 1;  // share that obstacles leave to be seen; in the truth of a simulation
};

inline constexpr double kMeasuredConfidence = 0.5;  // and above: seen, not interpolated

// The detections of one frame, in any order.
struct DetectionFrame {
  int frame = 0;
  std::vector<Detection> detections;
};

// The detections of one animal, by increasing frame, at most one a frame, gaps allowed.
struct Tracklet {
  Id id = 0;
  std::vector<Detection> detections;
};

// All tracklets of a sequence, by increasing id.
struct Tracks {
  std::optional<double> fps;  // as the file says, if it does [1/s]
  std::vector<Tracklet> tracklets;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_OBSERVATIONS_H_
