// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From the tracks of one camera to a flock in space. A track gives a ray per frame; how far along
// it the animal was follows from what is known of flight (equal speeds, smooth paths), from its
// apparent size, and for the absolute scale from what the user knows. Methods:
//   batch   one solve over the whole sequence (solve/batch.h): the best, with error bars
//   dynamics  batch with forces between the animals, where these earn it (solve/dynamics.h)
//   cobyla  frame by frame as published by Lin, 2019 (solve/cobyla.h): the baseline
//   lin-ceres  the same objective with another optimiser (solve/lin_ceres.cc)

#ifndef FLOCKLIFT_RECONSTRUCT_RECONSTRUCT_H_
#define FLOCKLIFT_RECONSTRUCT_RECONSTRUCT_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/initialize/second_camera.h"
#include "reconstruct/knowledge.h"
#include "reconstruct/solve/batch.h"
#include "reconstruct/solve/batch_options.h"
#include "reconstruct/solve/cobyla.h"
#include "reconstruct/solve/dynamics.h"
#include "simulate/camera/camera.h"
#include "simulate/core/observations.h"
#include "simulate/core/progress.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

enum class ReconstructMethod { kBatch, kDynamics, kCobyla, kLinCeres };
// Throws std::invalid_argument for a name that is none.
ReconstructMethod MethodOf(const std::string& name);
const char* NameOf(ReconstructMethod method);

struct ReconstructOptions {
  ReconstructMethod method = ReconstructMethod::kBatch;
  Knowledge knowledge;              // anchors in the world frame; up_in_cam is set by the camera
  std::optional<double> pitch_deg;  // optical axis above the horizon, for a camera without pose
  BatchOptions batch;
  DynamicsOptions dynamics;
  CobylaOptions cobyla;  // speed, near and far follow `knowledge` where it has them
  std::optional<SecondCamera> second_camera;
  FirstDepths cobyla_first_depths;  // of the first frame, by id [m]
  // File that a killed run of batch or dynamics goes on from; empty: none.
  std::filesystem::path checkpoint = {};
};

struct ReconstructReport {
  ReconstructMethod method = ReconstructMethod::kBatch;
  int segments = 0, cuts = 0;  // tracks as solved, and where their motion jumped
  double pixel_sd = 0;         // noise of an image position [px]
  double initial_cost = 0, final_cost = 0;
  int iterations = 0;
  bool converged = false;
  bool erratic = false;    // animals were taken to keep no speed (cost_functions/erratic_flight.h)
  double scale_sd = 0;     // relative sd of the common scale; 0: the method does not know
  std::string scale_from;  // which priors fixed it
  std::string outlook;     // the same before solving
  std::string observability;  // in words: what relative depth rests on
  double relative_sd = 0;     // median relative sd of a depth, common scale taken out
  // Where speed and wingspan are both stated: log of the speed that the sizes tell over the stated
  // one, with the sd of what sizes tell.
  std::optional<Uncertain> speed_by_sizes;
  std::vector<TermStatistics> terms;
  std::vector<std::pair<std::string, double>> spreads;  // of the priors, as estimated
  std::optional<DynamicsReport> dynamics;
  std::optional<SecondCameraReport> second_camera;
  std::vector<std::string> warnings;

  bool IsUsable() const { return segments > 0 && final_cost < 1e300; }
};

struct ReconstructResult {
  Trajectories trajectories;  // one point per row of the tracks, in the camera file's world frame
  ReconstructReport report;
};

// What relative depth will rest on, before anything is solved (initialize/observability.h).
std::string LookAhead(const ReconstructOptions& options, const Tracks& tracks, const Camera& camera,
                      double fps);

// Throws std::invalid_argument when nothing fixes the scale, fps is not positive or an option is
// out of range. Never returns a NaN: an animal of which little is seen gets a wide sd_depth.
ReconstructResult Reconstruct(const ReconstructOptions& options, const Tracks& tracks,
                              const Camera& camera, double fps, int threads,
                              const Progress& progress);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_RECONSTRUCT_H_
