// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/visibility.h"

#include <algorithm>
#include <cmath>

#include "simulate/render/coverage.h"

namespace flocklift {

namespace {

// How many of a pixel's samples see something nearer.
int InFront(int u, int v, float nearness, const DepthBuffer& surfaces) {
  return surfaces.Covered(u, v) - surfaces.Behind(u, v, nearness);
}

// Does any pixel of the mask see something nearer?
bool AnyInFront(const CoverageMask& mask, float nearness, const DepthBuffer& surfaces) {
  for (int v = mask.top(); v < mask.top() + mask.height(); ++v) {
    const DepthBuffer::Range touched = surfaces.Touched(v);
    const int last = std::min(mask.left() + mask.width(), touched.last);
    for (int u = std::max(mask.left(), touched.first); u < last; ++u) {
      if (InFront(u, v, nearness, surfaces) > 0) return true;
    }
  }
  return false;
}

}  // namespace

double VisibleShare(const ProjectedBody& body, const DepthBuffer& surfaces) {
  if (surfaces.empty()) return 1;
  CoverageMask mask(BoundsOf(body.silhouette), surfaces.width(), surfaces.height());
  const auto nearness = static_cast<float>(1 / body.depth);
  if (mask.empty() || !AnyInFront(mask, nearness, surfaces)) return 1;
  mask.Add(body.silhouette, 1);
  mask.Finish();
  double all = 0, hidden = 0;
  for (int row = 0; row < mask.height(); ++row) {
    const int v = mask.top() + row;
    for (int k = 0; k < mask.width(); ++k) {
      const double share = mask.Row(row)[k];
      all += share;
      hidden += share * InFront(mask.left() + k, v, nearness, surfaces) / DepthBuffer::kSamples;
    }
  }
  return all > 0 ? 1 - hidden / all : 1;
}

double VisibleShare(const Vec2d& center, double depth, const DepthBuffer& surfaces) {
  if (surfaces.empty()) return 1;
  const auto nearness = static_cast<float>(1 / depth);
  const int left = static_cast<int>(std::floor(center.x));
  const int top = static_cast<int>(std::floor(center.y));
  double all = 0, hidden = 0;
  for (int v = std::max(top, 0); v <= std::min(top + 1, surfaces.height() - 1); ++v) {
    for (int u = std::max(left, 0); u <= std::min(left + 1, surfaces.width() - 1); ++u) {
      const double share = (1 - std::abs(u - center.x)) * (1 - std::abs(v - center.y));
      all += share;
      hidden += share * InFront(u, v, nearness, surfaces) / DepthBuffer::kSamples;
    }
  }
  return all > 0 ? 1 - hidden / all : 1;
}

}  // namespace flocklift
