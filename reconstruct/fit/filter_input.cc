// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/filter_input.h"

#include <algorithm>

namespace flocklift {

FilterInput::FilterInput(const ObservedFlock& flock)
    : first_frame_(flock.span().first), animals_(flock.animals()), dt_(flock.dt()) {
  for (int f = flock.span().first; f <= flock.span().last; ++f) {
    std::vector<Sighting>& sightings = frames_.emplace_back();
    for (int i = 0; i < animals_; ++i) {
      if (flock.Measured(i, f)) sightings.push_back({i, flock.Position(i, f)});
    }
  }
  std::array<double, 3> sums{}, counts{};
  for (int i = 0; i < animals_; ++i) {
    std::array<Vec3d, 3> recent;  // second differences, the newest first
    int run = 0;
    for (int f = flock.Life(i).first; f <= flock.Life(i).last; ++f) {
      run = flock.Measured(i, f) ? run + 1 : 0;
      if (run < 3) continue;
      recent = {flock.Position(i, f) - 2.0 * flock.Position(i, f - 1) + flock.Position(i, f - 2),
                recent[0], recent[1]};
      for (int lag = 0; lag < std::min(3, run - 2); ++lag) {
        const auto at = static_cast<std::size_t>(lag);
        sums[at] += Dot(recent[0], recent[at]) / 3;
        counts[at] += 1;
      }
    }
  }
  for (std::size_t lag = 0; lag < 3; ++lag) second_differences_[lag] = sums[lag] / counts[lag];
}

std::size_t FilterInput::sightings() const {
  std::size_t count = 0;
  for (const auto& sightings : frames_) count += sightings.size();
  return count;
}

}  // namespace flocklift
