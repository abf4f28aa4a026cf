// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Curl noise (equations.md, section 4; R. Bridson, J. Hourihan, M. Nordenstam, "Curl-noise for
// procedural fluid flow", SIGGRAPH 2007): a velocity field without sources,
//   V = curl N,   N(x) = gain (P_1, P_2, P_3)(x / scale)
// from three independent gradient noises P_k. Derivatives are analytic, so the divergence of V is
// zero to round-off. |V| is of the order gain / scale.
//
// Several potentials may be summed before the curl; a potential that changes with time is such a
// sum (NoiseTermsAt): every `evolution` seconds another seed takes over, by weights whose squares
// sum to 1, so that the field is as strong at all times.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_CURL_NOISE_H_
#define FLOCKLIFT_SIMULATE_FIELDS_CURL_NOISE_H_

#include <cstdint>
#include <vector>

#include "simulate/core/vec3.h"
#include "simulate/fields/lattice.h"
#include "simulate/fields/perlin_noise.h"

namespace flocklift {

// One potential.
template <typename T>
struct NoiseTerm {
  T gain;   // [m^2/s]
  T scale;  // edge of a lattice cell [m], above 0
  std::uint32_t seed;
};

// A potential N at a point [m^2/s], and gradient[k] of its component k [m/s].
template <typename T>
struct PotentialSample {
  Vec3<T> value;
  Vec3<T> gradient[3];
};

template <typename T>
[[gnu::always_inline]] inline PotentialSample<T> NoisePotential(const NoiseTerm<T>& term,
                                                                const Vec3<T>& x) {
  const T per_cell = T(1.0) / term.scale, slope = term.gain * per_cell;
  const NoiseCell<T> cell = MakeNoiseCell(LatticeHash{term.seed}, x * per_cell);
  const NoiseSample<T> a = NoiseInCell<0>(cell), b = NoiseInCell<1>(cell), c = NoiseInCell<2>(cell);
  return {Vec3<T>{a.value, b.value, c.value} * term.gain,
          {a.gradient * slope, b.gradient * slope, c.gradient * slope}};
}

template <typename T>
Vec3<T> Curl(const PotentialSample<T>& n) {
  return {n.gradient[2].y - n.gradient[1].z, n.gradient[0].z - n.gradient[2].x,
          n.gradient[1].x - n.gradient[0].y};
}

// V at x [m/s].
template <typename T>
[[gnu::always_inline]] inline Vec3<T> CurlNoise(const NoiseTerm<T>& term, const Vec3<T>& x) {
  return Curl(NoisePotential(term, x));
}

// The baseline that curl noise is compared with, gain / scale (P_1, P_2, P_3)(x / scale): as
// strong, but with sinks, where animals gather [m/s].
template <typename T>
[[gnu::always_inline]] inline Vec3<T> PerlinVelocity(const NoiseTerm<T>& term, const Vec3<T>& x) {
  return NoisePotential(term, x).value * (T(1.0) / term.scale);
}

// Of a sum of potentials.
template <typename T>
PotentialSample<T> NoisePotential(const std::vector<NoiseTerm<T>>& terms, const Vec3<T>& x) {
  PotentialSample<T> sum{};
  for (const NoiseTerm<T>& term : terms) {
    const PotentialSample<T> n = NoisePotential(term, x);
    sum.value += n.value;
    for (int k = 0; k < 3; ++k) sum.gradient[k] += n.gradient[k];
  }
  return sum;
}

struct NoiseOptions {
  double gain = 0.25;    // [m^2/s]
  double scale = 0.4;    // [m], above 0
  double evolution = 0;  // the potential is another one after so long [s]; 0: it stays
  int octaves = 1;       // each with half the scale and half the gain of the one before, 1 to 8
  std::uint64_t seed = 1;
};

// The potentials whose sum is N at a time [s]. std::invalid_argument for options out of range.
std::vector<NoiseTerm<double>> NoiseTermsAt(const NoiseOptions& options, double time);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_CURL_NOISE_H_
