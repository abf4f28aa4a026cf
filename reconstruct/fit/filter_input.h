// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The positions that a sweep of the filter (flock_filter.h) reads, by frame, copied out once for
// many sweeps, and the moments of their second differences over time, which say how large process
// noise and position noise may be.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_FILTER_INPUT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_FILTER_INPUT_H_

#include <array>
#include <utility>
#include <vector>

#include "reconstruct/fit/observed_flock.h"

namespace flocklift {

// What single precision, which flocks fly in and are written in, adds to each component of every
// position and velocity in every step [m^2, m^2/s^2]. A sum that grows alike is rounded alike, so
// that it is no noise of independent errors: taken for such, they have to be the largest. Positions
// count from their mean, since what was recorded far from where its world begins was not rounded.
struct Rounding {
  double position = 0, velocity = 0;
};

class FilterInput {
 public:
  explicit FilterInput(const ObservedFlock& flock);

  struct Sighting {
    int animal = 0;
    Vec3d position;
  };
  const std::vector<std::vector<Sighting>>& frames() const { return frames_; }
  std::size_t sightings() const;
  // The same animals in the same frames, elsewhere.
  FilterInput With(std::vector<std::vector<Sighting>> frames) const {
    FilterInput other = *this;
    other.frames_ = std::move(frames);
    return other;
  }
  int first_frame() const { return first_frame_; }
  int animals() const { return animals_; }
  double dt() const { return dt_; }
  const Rounding& rounding() const { return rounding_; }
  // Moments of second differences: what a start of q and s is made of. Variance and covariances
  // over one and two frames, per axis [m^2]; NaN without any.
  const std::array<double, 3>& second_differences() const { return second_differences_; }

 private:
  std::vector<std::vector<Sighting>> frames_;
  int first_frame_ = 0, animals_ = 0;
  double dt_ = 0;
  Rounding rounding_;
  std::array<double, 3> second_differences_{};
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_FILTER_INPUT_H_
