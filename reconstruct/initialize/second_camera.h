// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The tracks of a second camera that saw the same animals, from another place and perhaps by
// another clock: which of its tracks show which animals, and how far its clock is off, from the
// distances of its sightings to the epipolar lines of the first camera's. What it saw becomes
// views of the animals (segments.h): triangulation then is just more residuals of the solver.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_SECOND_CAMERA_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_SECOND_CAMERA_H_

#include <optional>

#include "reconstruct/initialize/reference_axes.h"
#include "reconstruct/initialize/segments.h"
#include "simulate/camera/camera.h"
#include "simulate/core/observations.h"

namespace flocklift {

struct SecondCamera {
  Tracks tracks;                 // ids mean nothing to the first camera
  Camera camera;                 // its pose in the same world
  double fps = 0;                // [1/s]
  std::optional<double> offset;  // what its time, (frame - 1) / fps, lacks to the first's [s];
                                 // absent: found within `search` of 0
  double search = 2;             // [s]
};

struct SecondCameraReport {
  int tracks = 0;     // of the second camera
  int matched = 0;    // of them, to an animal
  int ambiguous = 0;  // that fit more than one animal: left out
  long views = 0;     // sightings taken over
  double offset = 0;  // [s]
  double error = 0;   // median distance from the epipolar line [px of the second camera]
};

// Gives the segments, which `axes` and `fps` belong to, their views. Deterministic.
SecondCameraReport AttachViews(const SecondCamera& second, const SegmentOptions& options,
                               const ReferenceAxes& axes, int first_frame, double fps,
                               Segments* segments);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_SECOND_CAMERA_H_
