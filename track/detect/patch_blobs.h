// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The blobs of one patch of candidates: cut where there is a deep saddle (watershed.h), and
// measured from the contrast c of the picture as it is, c = |B - I|,
//   mass = sum c,   centre = sum c x / mass,   moments = sum c (x - centre)(x - centre)' / mass,
// and its box from the outline (outline.h).

#ifndef FLOCKLIFT_TRACK_DETECT_PATCH_BLOBS_H_
#define FLOCKLIFT_TRACK_DETECT_PATCH_BLOBS_H_

#include <span>
#include <vector>

#include "track/detect/background.h"
#include "track/detect/blob.h"
#include "track/detect/components.h"
#include "track/detect/watershed.h"
#include "track/gray_image.h"

namespace flocklift {

// The picture, lightly smoothed too, before its background.
struct ContrastView {
  const GrayImage& image;
  const GrayImage& smooth;
  const LevelTable& level;
  double sign = 1;  // of dark animals; -1: of bright ones
};

struct BlobLimits {
  double noise = 1;          // sd about the patch [grey levels]
  double least_peak = 0;     // [grey levels]
  int min_area = 1;          // [px]
  double longest_side = 50;  // of the box of whole pixels [px]
};

class PatchCutter {
 public:
  // Appends the blobs that keep the limits.
  void Append(const Component& patch, const ContrastView& view, const BlobLimits& limits,
              BlobFrame* found);

 private:
  Box BoxOfOutline(std::span<const BlobPixel> pixels, const Box& whole);

  std::vector<float> contrast_, raw_, columns_, rows_;  // kept: no patch allocates them anew
  Watershed watershed_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_PATCH_BLOBS_H_
