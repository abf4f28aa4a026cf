// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Intrinsics from views of a flat board: Zhang, "A flexible new technique for camera calibration",
// PAMI 22, 2000, as OpenCV refines it: least squares over the corners' image positions, with one
// pose of the board per view. Views whose residuals stand out are dropped and the rest fitted
// again.

#ifndef FLOCKLIFT_SIMULATE_CAMERA_CALIBRATE_H_
#define FLOCKLIFT_SIMULATE_CAMERA_CALIBRATE_H_

#include <optional>
#include <vector>

#include "simulate/camera/board.h"
#include "simulate/camera/camera.h"
#include "simulate/core/options.h"

namespace flocklift {

struct CalibrateOptions {
  int distortion = 5;           // coefficients that are fitted: 0, 4, 5, 8 or 12
  double outlier_factor = 3.0;  // a view with more than this times the median error is dropped
};

template <typename Visitor>
void Describe(Visitor& visit, CalibrateOptions& o) {
  visit("distortion", o.distortion, {.low = 0, .high = 12}, "",
        "distortion coefficients that are fitted: 0, 4, 5, 8 or 12");
  visit("outlier-factor", o.outlier_factor, {.low = 1.5, .high = 1e6}, "",
        "drop views whose error is more than this times the median");
}

inline constexpr int kFewestViews = 4;

struct Calibration {
  Camera camera;                 // no pose, no fps
  Intrinsics sd;                 // standard deviation of each, from the residuals; 0: not fitted
  double focal_sd = 0;           // relative, of fx and fy together: what depth suffers from
  double reprojection_rms = 0;   // over all corners of the views kept [px]
  double coverage = 0;           // share of an 8 x 6 division of the image that held corners
  std::vector<double> view_rms;  // of each view given [px]
  std::vector<bool> view_kept;
};

// Needs kFewestViews views that were found, all of width x height pictures. Nothing when the views
// do not determine a camera: boards that all face it, or views of different boards (focal_sd above
// kLargestFocalSd). The standard deviations take the corners' errors as independent; a board that
// is not flat adds an error of its own.
inline constexpr double kLargestFocalSd = 0.1;
std::optional<Calibration> CalibrateCamera(const std::vector<BoardView>& views, int width,
                                           int height, const CalibrateOptions& options);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_CALIBRATE_H_
