// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gradient noise (simulate/fields/lattice.h) on SIMD packs. The gradients come from the numbers of
// the edges by bit logic; an instruction set that has a table of bytes may specialize
// GradientOfPack for its packs, with the same result.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LATTICE_PACK_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LATTICE_PACK_H_

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/fields/lattice.h"

namespace flocklift {

// The doubled gradient whose number stands in the top four bits of `number`.
template <typename Arch>
struct GradientOfPack {
  using Pack = xsimd::batch<float, Arch>;
  using Bits = xsimd::batch<std::uint32_t, Arch>;

  // The first factor of Perlin's u + v has the sign of bit 0, the second that of bit 1.
  [[gnu::always_inline]] static Vec3<Pack> At(const Bits& number) {
    const Bits top(0x80000000U), two(0x40000000U), none(0U);
    const Bits u = ((number << 3) & top) | two, v = ((number << 2) & top) | two;
    const Bits index = number >> 28;
    const auto first_y = index > Bits(7U), second_y = index < Bits(4U),
               second_x = (index & Bits(13U)) == Bits(12U);
    const Bits x = xsimd::select(first_y, xsimd::select(second_x, v, none), u);
    const Bits y = xsimd::select(first_y, u, xsimd::select(second_y, v, none));
    const Bits z = xsimd::select(second_x, none, xsimd::select(second_y, none, v));
    return {xsimd::bitwise_cast<Pack>(x), xsimd::bitwise_cast<Pack>(y),
            xsimd::bitwise_cast<Pack>(z)};
  }
};

template <typename Arch>
struct Lattice<xsimd::batch<float, Arch>> {
  using Pack = xsimd::batch<float, Arch>;
  using Bits = xsimd::batch<std::uint32_t, Arch>;

  [[gnu::always_inline]] static Bits Cell(const Pack& whole) {
    return xsimd::bitwise_cast<Bits>(xsimd::to_int(whole));
  }
  template <int kNoise>
  [[gnu::always_inline]] static Vec3<Pack> DoubledGradient(const Bits& bits) {
    return GradientOfPack<Arch>::At(kNoise == 0 ? bits : bits << (4 * kNoise));
  }
  [[gnu::always_inline]] static Pack AddExactProduct(const Pack& a, const Pack& b, const Pack& c) {
    return xsimd::fma(a, b, c);
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LATTICE_PACK_H_
