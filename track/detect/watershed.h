// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts a patch of contrast where it has a deep saddle: two animals that touch have two peaks with a
// dip between them, one animal has (nearly) one.

#ifndef FLOCKLIFT_TRACK_DETECT_WATERSHED_H_
#define FLOCKLIFT_TRACK_DETECT_WATERSHED_H_

#include <cstdint>
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

class Watershed {
 public:
  // The number of parts of a patch: `contrast` is width x height, 0 outside the patch; parts are
  // 8-connected.
  int Cut(const std::vector<float>& contrast, int width, int height,
          const WatershedOptions& options);

  // After Cut, where there are two parts or more: that of each pixel, -1 outside; parts are
  // numbered from 0 by decreasing peak.
  const std::vector<int>& part() const { return part_; }

 private:
  // A part that grows from its peak downwards; one that was joined to another points to it.
  struct Basin {
    float peak = 0;
    double mass = 0;
    int parent = 0;
  };

  void SetPatch(const std::vector<float>& contrast, int width, int height);
  bool IsWhole(const WatershedOptions& options) const;
  int Root(int basin);
  void Flood(const WatershedOptions& options);

  // The patch inside a border of zeros, so that every pixel has eight neighbours. All memory is
  // kept from patch to patch.
  int width_ = 0, height_ = 0, stride_ = 0;
  std::vector<float> contrast_;
  float peak_ = 0, lowest_ = 0;  // of the pixels that are not 0
  std::vector<std::uint64_t> keys_;
  std::vector<int> label_, number_, part_;
  std::vector<Basin> basins_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_WATERSHED_H_
