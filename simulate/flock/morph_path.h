// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The path of a flock that morphs (simulate/flock/flock_morph.h) as its tetrahedra follow it, one
// segment between two key points after the other. The plane in the middle between key points i and
// i + 1 is the gate to segment i + 1: beyond it the second is nearer. The last segment's gate is
// the path's end.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MORPH_PATH_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MORPH_PATH_H_

#include <cstdint>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

class MorphPath {
 public:
  struct Segment {
    Vec3<float> way;   // unit direction
    Vec3<float> from;  // the first key point [m]
    float gate;        // along the way, where the next segment begins [m]
  };

  MorphPath() = default;
  // Key points that coincide are one. Throws std::invalid_argument for fewer than two.
  explicit MorphPath(const std::vector<Vec3d>& key_points);

  const std::vector<Vec3d>& points() const { return points_; }
  const Segment& At(std::uint32_t segment) const { return segments_[segment]; }

  // The segment on which somebody at p is who was on `segment` before; beyond the path's end as
  // many as there are.
  std::uint32_t Onwards(std::uint32_t segment, const Vec3<float>& p) const;
  bool AtEnd(std::uint32_t segment) const { return segment == segments_.size(); }

 private:
  std::vector<Vec3d> points_;
  std::vector<Segment> segments_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MORPH_PATH_H_
