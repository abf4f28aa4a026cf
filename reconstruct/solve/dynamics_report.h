// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What came of forces between the animals (dynamics.h).

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_DYNAMICS_REPORT_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_DYNAMICS_REPORT_H_

#include <string>
#include <utility>
#include <vector>

namespace flocklift {

// Of one window, or over all.
struct DynamicsReport {
  int windows = 0, kept = 0;  // tried, and with forces
  double weight = 0;          // of the solution with forces where it counts, on average
  long hidden = 0;            // sightings
  double batch_error = 0;     // mean error of the predicted image positions, in their sds
  double dynamics_error = 0;
  // Of the last window with forces: by the names of boids, `goal` for the goal's weight, `drive`
  // for the cruising speed over the mean speed.
  std::vector<std::pair<std::string, double>> forces;
};

// Adds that of another window.
void Merge(const DynamicsReport& window, DynamicsReport* report);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_DYNAMICS_REPORT_H_
