// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Connected components (8 neighbours) of a mask, by runs and union-find.

#ifndef FLOCKLIFT_TRACK_DETECT_COMPONENTS_H_
#define FLOCKLIFT_TRACK_DETECT_COMPONENTS_H_

#include <vector>

#include "track/gray_image.h"

namespace flocklift {

// Pixels first .. last of row v.
struct PixelRun {
  int v = 0, first = 0, last = 0;
};

struct Component {
  int left = 0, top = 0, right = 0, bottom = 0;  // inclusive
  int area = 0;
  std::vector<PixelRun> runs;  // by row, then column
};

// The components of the pixels that are not 0, in the order of their first pixel.
std::vector<Component> FindComponents(const GrayImage& mask);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_COMPONENTS_H_
