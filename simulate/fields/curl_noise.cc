// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/curl_noise.h"

#include <cmath>
#include <numbers>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

std::uint32_t TermSeed(std::uint64_t seed, int octave, std::int64_t epoch) {
  const auto e = static_cast<std::uint64_t>(epoch);
  return Philox4x32({static_cast<std::uint32_t>(octave), static_cast<std::uint32_t>(e),
                     static_cast<std::uint32_t>(e >> 32), 0x6e6f6973U},
                    {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)})[0];
}

}  // namespace

std::vector<NoiseTerm<double>> NoiseTermsAt(const NoiseOptions& options, double time) {
  Check(options.scale > 0, "the scale of noise must be positive");
  Check(options.evolution >= 0, "noise cannot evolve backwards");
  Check(options.octaves >= 1 && options.octaves <= 8, "noise has 1 to 8 octaves");
  const double age = options.evolution > 0 ? time / options.evolution : 0;
  const double epoch = std::floor(age);
  const double angle = 0.5 * std::numbers::pi * Fade(age - epoch);
  const double share[2] = {std::cos(angle), std::sin(angle)};

  std::vector<NoiseTerm<double>> terms;
  for (int octave = 0; octave < options.octaves; ++octave) {
    const double part = std::ldexp(1.0, -octave);
    for (int late = 0; late < 2; ++late) {
      if (share[late] == 0) continue;
      terms.push_back({options.gain * part * share[late], options.scale * part,
                       TermSeed(options.seed, octave, static_cast<std::int64_t>(epoch) + late)});
    }
  }
  return terms;
}

}  // namespace flocklift
