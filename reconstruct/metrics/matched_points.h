// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Truth and reconstruction side by side: which reconstructed point stands for which true one.
// Either the ids agree, or, for results that carry ids of their own, every result id (a fragment
// counts too) belongs to the animal that it is nearest to in the image in most of its frames.

#ifndef FLOCKLIFT_RECONSTRUCT_METRICS_MATCHED_POINTS_H_
#define FLOCKLIFT_RECONSTRUCT_METRICS_MATCHED_POINTS_H_

#include <cstdint>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct MatchOptions {
  bool by_image = false;
  double gate_px = 15;  // farther from every animal in the image, a point votes for none
};

template <typename Visitor>
void Describe(Visitor& visit, MatchOptions& o) {
  visit("match-gate", o.gate_px, {.low = 0.1, .high = 1e5}, "px",
        "image distance within which a result point votes for an animal (match by image)");
}

struct MatchedPoint {
  int frame = 0;
  Id truth_id = 0;
  Id result_id = 0;
  Vec3d truth_in_world;
  Vec3d result_in_world;
  double truth_depth = 0;   // camera-frame z, positive [m]
  double result_depth = 0;  // [m]
  double sd_depth = 0;      // as the result states it [m]; 0: it does not
};

struct MatchedTrajectories {
  std::vector<MatchedPoint> points;       // by truth id, then frame
  std::int64_t truth_rows = 0;            // all of the truth's rows
  std::int64_t truth_rows_in_view = 0;    // those inside the camera's picture; 0: size unknown
  std::int64_t matched_rows_in_view = 0;  // of these, how many have a result
};

// Both in the world frame. Truth behind the camera is never matched.
MatchedTrajectories MatchTrajectories(const MatchOptions& options, const Camera& camera,
                                      const Trajectories& truth, const Trajectories& result);

// Points and velocities of a file in camera coordinates, in the world frame.
Trajectories WorldFromCamera(const Camera& camera, const Trajectories& in_camera);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_METRICS_MATCHED_POINTS_H_
