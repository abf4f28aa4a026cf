// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/visibility.h"

#include "simulate/render/coverage.h"

namespace flocklift {

double VisibleShare(const ProjectedBody& body, const DepthBuffer& surfaces) {
  if (surfaces.empty()) return 1;
  CoverageMask mask(BoundsOf(body.silhouette), surfaces.width(), surfaces.height());
  if (mask.empty()) return 1;
  mask.Add(body.silhouette, 1);
  mask.Finish();
  const auto nearness = static_cast<float>(1 / body.depth);
  double all = 0, hidden = 0;
  for (int row = 0; row < mask.height(); ++row) {
    const int v = mask.top() + row;
    for (int k = 0; k < mask.width(); ++k) {
      const int u = mask.left() + k;
      const double share = mask.Row(row)[k];
      const int in_front = surfaces.Covered(u, v) - surfaces.Behind(u, v, nearness);
      all += share;
      hidden += share * in_front / DepthBuffer::kSamples;
    }
  }
  return all > 0 ? 1 - hidden / all : 1;
}

}  // namespace flocklift
