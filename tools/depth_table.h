// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Methods of depth side by side on the synthetic cases (depth_case.h): one row for each scene,
// number of birds and method, the figures means over the seeds.

#ifndef FLOCKLIFT_TOOLS_DEPTH_TABLE_H_
#define FLOCKLIFT_TOOLS_DEPTH_TABLE_H_

#include <optional>
#include <string>
#include <vector>

#include "reconstruct/metrics/trajectory_scores.h"
#include "reconstruct/reconstruct.h"
#include "tools/depth_case.h"

namespace flocklift {

// A way to call a method.
struct DepthMethod {
  std::string name;  // of the row, and of the result's file
  ReconstructMethod method = ReconstructMethod::kBatch;
  bool use_size = true;
  bool current_frame = false;  // of Lin's methods: neighbours of the frame being solved
};

const std::vector<DepthMethod>& DepthMethods();

// What one method makes of one twin.
struct DepthRun {
  TrajectoryScores scores;
  double cpu_ms = 0;  // per bird and frame
  ReconstructReport report;
  Trajectories result;
};
DepthRun RunDepthMethod(const DepthMethod& method, const DepthTwin& twin, int threads);

struct DepthRow {
  std::string scene;
  int birds = 0;
  std::string method;
  std::vector<TrajectoryScores> scores;  // one for each seed
  std::vector<double> cpu_ms;
};

// Markdown: absolute and scaled errors (median / 90th percentile in %), how much of the best
// constant depth's error that is, the order of depths, coverage and cost. The constant depth itself
// is the first row of each scene.
std::string DepthTable(const std::vector<DepthRow>& rows);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_DEPTH_TABLE_H_
