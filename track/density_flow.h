// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What can be said of animals that cannot be told apart: how many there are and where they go, by
// square cells. The count of a cell is its contrast over that of one animal, a common mass of a
// patch; animals that hide each other make it too low. The velocity is the shift at which two
// consecutive frames of a cell correlate best (phase correlation, Kuglin and Hines 1975), as in
// particle image velocimetry.

#ifndef FLOCKLIFT_TRACK_DENSITY_FLOW_H_
#define FLOCKLIFT_TRACK_DENSITY_FLOW_H_

#include <filesystem>
#include <optional>
#include <vector>

#include "simulate/core/progress.h"
#include "simulate/core/vec3.h"
#include "track/detect/detector.h"

namespace flocklift {

struct FlowCell {
  int frame = 1;
  Vec2d center;                   // [px]
  double count = 0;               // animals, at least
  std::optional<Vec2d> velocity;  // [px/frame]; nothing: no clear correlation
};

struct DensityFlow {
  double cell = 0;              // side [px]
  int stride = 1;               // every so many-th frame was looked at
  std::vector<FlowCell> cells;  // those with animals, by frame, row and column
  double median_count = 0;      // animals in a frame
  double median_density = 0;    // of a cell with animals [1/px^2]
  double median_speed = 0;      // of a cell [px/frame]
  double polarisation = 0;      // |sum of count * v / |v|| over sum of count, mean over frames
};

// Reads the footage anew; every `stride`-th frame and the one after it are looked at.
DensityFlow MeasureDensityFlow(const DetectorOptions& options, const std::filesystem::path& path,
                               const Progress& progress = {}, int stride = 5);

// `frame,x,y,count,u,v` with header; u and v are empty where there is no velocity.
void WriteDensityFlow(const std::filesystem::path& path, const DensityFlow& flow);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DENSITY_FLOW_H_
