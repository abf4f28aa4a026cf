// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What gradient noise asks of a scalar T besides arithmetic: the number of its lattice cell, random
// bits for a lattice point, and the gradient that they choose. Here for float, double and dual
// numbers (ceres::Jet; the value is the member `a`); a SIMD pack brings its own (one
// specialization, in simulate/flock/kernels/).
//
// Gradients are the twelve edges of a cube, four of them twice, numbered as in K. Perlin,
// "Improving noise", SIGGRAPH 2002. They come doubled, 0 or +-2 a component: numbers that one byte
// of a float holds, and exact factors all the same. Whoever uses them halves the sum at the end.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_LATTICE_H_
#define FLOCKLIFT_SIMULATE_FIELDS_LATTICE_H_

#include <cstdint>

#include "simulate/core/vec3.h"

namespace flocklift {

// One word of random bits chooses the gradients of three noises: of noise k the four bits from
// LatticeShift(k) on, from the top of the word down.
constexpr int LatticeShift(int noise) { return 28 - 4 * noise; }

// clang-format off
inline constexpr signed char kDoubledGradients[16][3] = {
    {2, 2, 0}, {-2, 2, 0}, {2, -2, 0}, {-2, -2, 0}, {2, 0, 2}, {-2, 0, 2}, {2, 0, -2}, {-2, 0, -2},
    {0, 2, 2}, {0, -2, 2}, {0, 2, -2}, {0, -2, -2}, {2, 2, 0}, {0, -2, 2}, {-2, 2, 0}, {0, -2, -2}};
// clang-format on

template <typename T>
struct Lattice {
  using Bits = std::uint32_t;

  // Of a whole number; a whole number below 0 counts on from 2^32.
  static Bits Cell(const T& whole) {
    if constexpr (requires { whole.a; }) {
      return static_cast<Bits>(static_cast<std::int64_t>(whole.a));
    } else {
      return static_cast<Bits>(static_cast<std::int64_t>(whole));
    }
  }

  template <int kNoise>
  static Vec3<T> DoubledGradient(Bits bits) {
    const signed char* const g = kDoubledGradients[bits >> LatticeShift(kNoise) & 15];
    return {T(g[0]), T(g[1]), T(g[2])};
  }

  // a b + c where the product is exact, so that a fused operation rounds as the two do.
  static T AddExactProduct(const T& a, const T& b, const T& c) { return a * b + c; }
};

// Bits for the lattice point (x, y, z): the coordinates are brought together by a rank-1 lattice
// (powers of the inverse of the root of g^4 = g + 1, times 2^32), then mixed in two rounds. No
// table and no period of 256 cells.
struct LatticeHash {
  std::uint32_t seed;

  template <typename Bits>
  Bits operator()(const Bits& x, const Bits& y, const Bits& z) const {
    const Bits point = x * Bits(0xD1B54A33U) + y * Bits(0xABC98389U) + z * Bits(0x8CB92BA7U);
    const Bits mixed = (point ^ (point >> 16)) * Bits(0x2C1B3C6DU);
    return (mixed ^ (mixed >> 15) ^ Bits(seed)) * Bits(0x297A2D39U);
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_LATTICE_H_
