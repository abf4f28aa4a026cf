// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Who draws random numbers: each purpose has streams of its own (simulate/core/rng.h), so that
// switching one off does not change the others.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_STREAMS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_STREAMS_H_

#include <cstdint>

#include "simulate/core/rng.h"

namespace flocklift {

enum class Stream : std::uint64_t {
  kStart = 1,
  kBody = 2,
  kNoise = 3,
  kPredator = 4,
  kFlock = 5,
  kForceNoise = 6,
  kWind = 7,
  kKick = 8
};

inline Rng StreamOf(Stream purpose, std::uint64_t seed, std::uint64_t agent,
                    std::uint32_t step = 0) {
  return Rng(seed, static_cast<std::uint64_t>(purpose) << 48 | agent, step);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_STREAMS_H_
