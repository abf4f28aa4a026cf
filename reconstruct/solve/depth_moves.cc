// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/depth_moves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "reconstruct/solve/one_animal.h"

namespace flocklift::internal {
namespace {

constexpr std::array<double, 2> kSteps = {-0.08, 0.08};  // of the log depth
constexpr int kAlone = 8, kTogether = 20;                // iterations, at most
constexpr double kGain = 0.1;                            // of log probability that counts
constexpr std::size_t kFew = 30;
constexpr double kElsewhere = 0.015;  // rms of the log depth

// Another place for an animal, improbable by so much as long as all others stay.
struct Place {
  double worse = 0;
  std::size_t animal = 0;
  Bird bird;
};

Bird Moved(Bird bird, double step) {
  for (std::size_t k = 2; k < bird.path.size(); k += 3) bird.path[k] += step;
  bird.own[kOwnLogSpeed] += step;
  return bird;
}

double Between(const Bird& a, const Bird& b) {
  double sum = 0;
  for (std::size_t k = 2; k < a.path.size(); k += 3) {
    const double off = a.path[k] - b.path[k];
    sum += off * off;
  }
  return std::sqrt(3 * sum / static_cast<double>(a.path.size()));
}

// Puts those elsewhere that are more probable there at once. Returns how many, and adds where
// others might be.
int MoveAlone(const BatchModel& model, FollowedFlock* flock, std::vector<Place>* places) {
  constexpr double kRoom = 40;  // log probability that others may win by making room
  CoupledFlock coupled = flock->Coupled(model);
  OneAnimal one(&coupled);
  int moved = 0;
  for (std::size_t i = 0; i < flock->birds.size(); ++i) {
    one.Choose(i);
    double cost = one.Minimize(kAlone);
    Bird best = one.bird();
    for (const double step : kSteps) {
      one.Put(Moved(best, step));
      const double there = one.Minimize(kAlone);
      const bool elsewhere = Between(one.bird(), best) > kElsewhere;
      if (there < cost - kGain) {
        if (elsewhere) ++moved;
        cost = there;
        best = one.bird();
      } else if (elsewhere && there < cost + kRoom) {
        places->push_back({there - cost, i, one.bird()});
      }
    }
    one.Put(best);
  }
  return moved;
}

}  // namespace

int MoveDepths(const BatchModel& model, FollowedFlock* flock) {
  // Places that the whole flock settles for: each takes time with the number of animals.
  const std::size_t most = flock->birds.size() > kFew ? 4 : 8;
  std::vector<Place> places;
  const FollowedFlock before = *flock;
  int moved = MoveAlone(model, flock, &places);
  flock->Settle(model, kTogether);
  if (!(flock->improbable < before.improbable)) {
    *flock = before;
    moved = 0;
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.worse < b.worse; });
  places.resize(std::min(places.size(), most));
  for (const Place& place : places) {
    FollowedFlock other = *flock;
    other.birds[place.animal].path = place.bird.path;
    other.birds[place.animal].own = place.bird.own;
    other.Settle(model, kTogether, flock->improbable);
    if (!(other.improbable < flock->improbable - kGain)) continue;
    *flock = std::move(other);
    ++moved;
  }
  return moved;
}

}  // namespace flocklift::internal
