// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts a patch of contrast where it has a deep saddle: two animals that touch have two peaks with a
// dip between them, one animal has (nearly) one.

#ifndef FLOCKLIFT_TRACK_DETECT_WATERSHED_H_
#define FLOCKLIFT_TRACK_DETECT_WATERSHED_H_

#include <vector>

namespace flocklift {

// Two parts stay two if, where they meet, the lower peak stands at least
//   max(relative_dip * lower peak, least_dip)
// above the saddle, and the lighter part has at least `least_share` of the heavier part's mass.
struct WatershedOptions {
  double relative_dip = 0.35;
  double least_dip = 4;  // [grey levels]
  double least_share = 0.2;
};

// `contrast` is width x height, 0 outside the patch; parts are 8-connected. Returns the part of
// each pixel, -1 outside; parts are numbered from 0 by decreasing peak. `parts` is their number.
std::vector<int> CutAtSaddles(const std::vector<float>& contrast, int width, int height,
                              const WatershedOptions& options, int* parts);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_WATERSHED_H_
