// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/morph_path.h"

#include "simulate/core/check.h"
#include "simulate/flock/herd.h"

namespace flocklift {

MorphPath::MorphPath(const std::vector<Vec3d>& key_points) {
  for (const Vec3d& q : key_points) {
    if (points_.empty() || Norm(q - points_.back()) > 1e-9) points_.push_back(q);
  }
  Check(points_.size() >= 2, "a path needs two points");
  for (std::size_t k = 0; k + 1 < points_.size(); ++k) {
    const bool last = k + 2 == points_.size();
    const Vec3d &from = points_[k], &to = points_[k + 1];
    const Vec3d way = Normalized(to - from);
    segments_.push_back({Cast<float>(way), Cast<float>(from),
                         static_cast<float>(Dot(way, last ? to : 0.5 * (from + to)))});
  }
}

std::uint32_t MorphPath::Onwards(std::uint32_t segment, const Vec3<float>& p) const {
  while (!AtEnd(segment) && Dot(p, segments_[segment].way) > segments_[segment].gate) ++segment;
  return segment;
}

}  // namespace flocklift
