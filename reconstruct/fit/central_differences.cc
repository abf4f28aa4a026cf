// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/central_differences.h"

#include <vector>

namespace flocklift {

MotionRows CentralDifferenceRows(const FlockTerms& terms, const ObservedFlock& flock,
                                 std::span<const int> middles) {
  MotionRows rows;
  rows.terms = terms.free.size();
  const std::size_t width = rows.terms + 1;
  for (const int frame : middles) {
    std::vector<int> animals;
    std::vector<Vec3d> x, v;
    for (int i = 0; i < flock.animals(); ++i) {
      if (!flock.Has(i, frame - 1) || !flock.Has(i, frame) || !flock.Has(i, frame + 1)) continue;
      animals.push_back(i);
      x.push_back(flock.Position(i, frame));
      v.push_back((flock.Position(i, frame + 1) - flock.Position(i, frame - 1)) / (2 * flock.dt()));
    }
    std::vector<Vec3d> values(x.size() * terms.columns());
    terms.evaluate(x, v, values);
    for (std::size_t k = 0; k < animals.size(); ++k) {
      const Vec3d* const at = &values[k * terms.columns()];
      rows.frame.push_back(frame);
      rows.animal.push_back(animals[k]);
      rows.position.push_back(x[k]);
      rows.response.push_back((flock.Position(animals[k], frame + 1) - 2.0 * x[k] +
                               flock.Position(animals[k], frame - 1)) /
                              (flock.dt() * flock.dt()));
      rows.features.insert(rows.features.end(), at, at + rows.terms);
      rows.known.push_back(at[rows.terms]);
      rows.features.push_back(at[width]);
      rows.depth_sd.push_back(flock.SdDepth(animals[k], frame));
      rows.clamped.push_back(false);
    }
  }
  rows.near_known = rows.known;
  rows.near = rows.far = rows.features;
  return rows;
}

}  // namespace flocklift
