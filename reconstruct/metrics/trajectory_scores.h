// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How good a reconstruction is. With true depth z, reconstructed depth r and s = median(z / r):
//   depth error |r - z| / z, the same after one global scale |s r - z| / z, and what the best
//   single depth would score, |median(z) - z| / z: skill is the ratio to that. A figure means
//   nothing without its coverage, the share of true rows that have a result.
// Calibration: the share of errors within 1 and 2 sd_depth (0.68 and 0.95 are right). "Relative"
// takes the common scale out of both: |s r - z| against sqrt(sd^2 - (scale_sd r)^2).

#ifndef FLOCKLIFT_RECONSTRUCT_METRICS_TRAJECTORY_SCORES_H_
#define FLOCKLIFT_RECONSTRUCT_METRICS_TRAJECTORY_SCORES_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reconstruct/metrics/matched_points.h"

namespace flocklift {

struct TrajectoryScores {
  std::int64_t rows = 0;                                     // matched
  double coverage = 0;                                       // of all true rows
  std::optional<double> coverage_in_view;                    // of the true rows inside the picture
  double constant_error_median = 0, constant_error_p90 = 0;  // relative
  double error_median = 0, error_p90 = 0;
  double scaled_error_median = 0, scaled_error_p90 = 0;
  double scale = 1;  // s: multiply the result by it
  double skill = 0;  // error_median / constant_error_median
  double scaled_skill = 0;
  double extent = 0;  // median over frames of the flock's depth range [m]
  double error_over_extent = 0, scaled_error_over_extent = 0;
  std::optional<double> depth_spearman;  // mean over frames of at least 5 animals
  std::optional<double> velocity_angle;  // median, between true and reconstructed motion [deg]
  std::optional<double> within_1sd, within_2sd;
  std::optional<double> relative_within_1sd, relative_within_2sd;
  std::optional<double> scale_z;  // (1/s - 1) / scale_sd
};

// Nothing when no true row has a result. `scale_sd`: relative sd of the common scale as the
// reconstruction states it.
std::optional<TrajectoryScores> ScoreTrajectories(const MatchedTrajectories& matched,
                                                  std::optional<double> scale_sd);

// The figures by name, in the order of a table; errors in %, those without a value left out.
std::vector<std::pair<std::string, double>> Figures(const TrajectoryScores& scores);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_METRICS_TRAJECTORY_SCORES_H_
