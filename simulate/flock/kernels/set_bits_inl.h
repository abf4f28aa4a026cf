// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// For every mask of 8 bits the numbers of its set bits; included once by each variant.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SET_BITS_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SET_BITS_INL_H_

#include <cstdint>

namespace flocklift {
namespace {

struct SetBits {
  std::uint64_t of[256];  // one number a byte, from the lowest byte on; then zeros
};
constexpr SetBits MakeSetBits() {
  SetBits bits{};
  for (unsigned mask = 0; mask < 256; ++mask) {
    int count = 0;
    for (std::uint64_t k = 0; k < 8; ++k) {
      if ((mask >> k & 1U) != 0) bits.of[mask] |= k << (8 * count++);
    }
  }
  return bits;
}
constexpr SetBits kSetBits = MakeSetBits();

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SET_BITS_INL_H_
