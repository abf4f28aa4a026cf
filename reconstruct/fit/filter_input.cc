// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/filter_input.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flocklift {
namespace {

// Moments of vectors, per component.
class Spread {
 public:
  void Add(const Vec3d& v) {
    sum_ += v;
    squares_ += SquaredNorm(v);
    count_ += 1;
  }
  double MeanSquare() const { return count_ > 0 ? squares_ / (3 * count_) : 0; }
  double Variance() const {
    return count_ > 0 ? std::max(0.0, MeanSquare() - SquaredNorm(sum_ / count_) / 3) : 0;
  }

 private:
  Vec3d sum_;
  double squares_ = 0, count_ = 0;
};

// Square of the largest error, half the distance of neighbouring floats, of a component whose mean
// square this is.
double LargestRounding(double mean_square) {
  constexpr double kHalf = 0.5 * std::numeric_limits<float>::epsilon();
  return kHalf * kHalf * mean_square;
}

}  // namespace

FilterInput::FilterInput(const ObservedFlock& flock)
    : first_frame_(flock.span().first), animals_(flock.animals()), dt_(flock.dt()) {
  for (int f = flock.span().first; f <= flock.span().last; ++f) {
    std::vector<Sighting>& sightings = frames_.emplace_back();
    for (int i = 0; i < animals_; ++i) {
      if (flock.Measured(i, f)) sightings.push_back({i, flock.Position(i, f)});
    }
  }
  std::array<double, 3> sums{}, counts{};
  Spread position, velocity;
  for (int i = 0; i < animals_; ++i) {
    std::array<Vec3d, 3> recent;  // second differences, the newest first
    int run = 0;
    for (int f = flock.Life(i).first; f <= flock.Life(i).last; ++f) {
      run = flock.Measured(i, f) ? run + 1 : 0;
      if (run > 0) position.Add(flock.Position(i, f));
      if (run > 1) velocity.Add((flock.Position(i, f) - flock.Position(i, f - 1)) / dt_);
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
  rounding_ = {.position = LargestRounding(position.Variance()),
               .velocity = LargestRounding(velocity.MeanSquare())};
}

std::size_t FilterInput::sightings() const {
  std::size_t count = 0;
  for (const auto& sightings : frames_) count += sightings.size();
  return count;
}

}  // namespace flocklift
