// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The synthetic cases on which methods of depth are compared: a scene of data_synthetic/, the truth
// that the simulator makes of it, what a tracker would make of that, and what a user would know.

#ifndef FLOCKLIFT_TOOLS_DEPTH_CASE_H_
#define FLOCKLIFT_TOOLS_DEPTH_CASE_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "reconstruct/knowledge.h"
#include "simulate/camera/camera.h"
#include "simulate/core/observations.h"
#include "simulate/core/trajectory.h"
#include "simulate/synthetic.h"
#include "simulate/track_faults.h"

namespace flocklift {

struct DepthCase {
  std::string scene;  // depth_SCENE.toml
  ObservationNoise noise{.position_sd = 0.5, .size_sd = 0.05, .miss = 0, .clutter = 0};
  TrackFaults faults = {};
  double told_speed = 1;  // over the true mean speed
  double told_focal = 1;  // over the true focal length
};

// The five scenes that tell methods apart, each with what goes wrong in it.
const std::vector<DepthCase>& DepthCases();

struct DepthTwin {
  double fps = 0;
  Trajectories truth;  // of the rows that are there, under the names that the tracks have
  Tracks tracks;
  Camera camera;  // as the reconstruction is told
  Knowledge knowledge;
};

// `birds` animals, shared among the scene's species as in its file; seeds differ in everything that
// is drawn. The reconstruction is told the true mean wingspan (sd 5 % between animals, as is usual)
// and the true mean speed of what is seen, to 10 %.
DepthTwin MakeDepthTwin(const DepthCase& depth_case, const std::filesystem::path& scene_folder,
                        int birds, std::uint64_t seed, int threads);

// truth.csv (world frame), tracks.csv, shapes.csv and camera.yaml.
void WriteDepthTwin(const std::filesystem::path& folder, const DepthTwin& twin);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_DEPTH_CASE_H_
