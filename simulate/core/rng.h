// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Counter-based random numbers: what is drawn depends only on (seed, agent, step), never on the
// order of the calls, so that any number of threads draws the same. Philox4x32-10 of Salmon,
// Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011.

#ifndef FLOCKLIFT_SIMULATE_CORE_RNG_H_
#define FLOCKLIFT_SIMULATE_CORE_RNG_H_

#include <array>
#include <cstdint>

namespace flocklift {

// One block of Philox4x32-10: four 32-bit words of counter and two of key to four random words.
std::array<std::uint32_t, 4> Philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

// The stream of random numbers of one agent at one step. Cheap to make; make one per use.
class Rng {
 public:
  explicit Rng(std::uint64_t seed, std::uint64_t agent = 0, std::uint32_t step = 0);

  std::uint32_t Bits();
  double Uniform();  // in (0, 1), never 0 or 1
  double Uniform(double low, double high);
  double Normal();                         // mean 0, standard deviation 1 (Box-Muller)
  std::uint32_t Below(std::uint32_t end);  // 0 .. end - 1

 private:
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_RNG_H_
