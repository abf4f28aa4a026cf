// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Random accelerations of animals, each an Ornstein-Uhlenbeck process:
//   n(t + dt) = k n(t) + sd sqrt(1 - k^2) N(0, 1),   k = exp(-dt / time); time 0: white

#ifndef FLOCKLIFT_SIMULATE_FLOCK_CORRELATED_NOISE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_CORRELATED_NOISE_H_

#include <cmath>
#include <cstdint>
#include <vector>

#include "simulate/flock/herd.h"
#include "simulate/flock/streams.h"
#include "simulate/flock/world.h"

namespace flocklift {

template <typename T>
class CorrelatedNoise {
 public:
  CorrelatedNoise(Stream stream, std::size_t animals) : stream_(stream), state_(animals) {}

  // The next value of one animal [m/s^2]; `agent` counts within the herd.
  Vec3<T> Next(const Surroundings& around, std::uint64_t first_agent, std::uint32_t agent,
               double sd, double time) {
    Rng rng = StreamOf(stream_, around.world->seed, first_agent + agent, around.step);
    const double kept = time > 0 ? std::exp(-around.dt() / time) : 0;
    const double fresh = sd * std::sqrt(1 - kept * kept);
    const Vec3d draw{rng.Normal(), rng.Normal(), rng.Normal()};
    Vec3<T>& state = state_[agent];
    state = static_cast<T>(kept) * state + Cast<T>(fresh * draw);
    return state;
  }

  std::vector<Vec3<T>>& state() { return state_; }
  const std::vector<Vec3<T>>& state() const { return state_; }

 private:
  Stream stream_;
  std::vector<Vec3<T>> state_;  // by agent
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_CORRELATED_NOISE_H_
