// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a force term is: a stateless struct with `Params<T>` and pure functions of any scalar T
// (float, double, a SIMD pack, ceres::Jet). Two kinds:
//
// A pair term tells what neighbour j does to animal i, from dx = x_j - x_i and dv = v_j - v_i
// (world frame): a vector u_ij and how much it counts, w_ij. Those of all neighbours are summed,
// and Finish makes the acceleration:
//   a_i = Finish(p, { sum_j w_ij u_ij, sum_j w_ij })
// Which animals are neighbours is chosen outside and only has to include all within Reach(p); the
// animal itself is none of them.
//
// An agent term tells what the world does to an animal: a_i = At(p, x_i, v_i).

#ifndef FLOCKLIFT_SIMULATE_FORCES_TERM_H_
#define FLOCKLIFT_SIMULATE_FORCES_TERM_H_

#include <concepts>

#include "simulate/core/vec3.h"

namespace flocklift {

// What one neighbour says, and how much it counts: 1 inside a window, less on its edge, 0 outside.
template <typename T>
struct Share {
  Vec3<T> value;
  T weight;
};

// The sum over neighbours.
template <typename T>
struct Weighted {
  Vec3<T> value{T(0.0), T(0.0), T(0.0)};  // of weight * value
  T weight{T(0.0)};

  Weighted& operator+=(const Share<T>& share) {
    value += share.weight * share.value;
    weight += share.weight;
    return *this;
  }
  Weighted& operator+=(const Weighted& b) {
    value += b.value;
    weight += b.weight;
    return *this;
  }
};

template <typename Term, typename T>
concept PairTerm = requires(const typename Term::template Params<T>& p, const Vec3<T>& v,
                            const Weighted<T>& sum) {
  { Term::Pair(p, v, v) } -> std::same_as<Share<T>>;
  { Term::Finish(p, sum) } -> std::same_as<Vec3<T>>;
};

template <typename Term, typename T>
concept AgentTerm = requires(const typename Term::template Params<T>& p, const Vec3<T>& v) {
  { Term::At(p, v, v) } -> std::same_as<Vec3<T>>;
};

// The mean of the neighbours, and 0 where there is none. The divisor is the weight W itself from 1
// on, so that counts divide as published, and (1 + W^2) / 2 below: with soft windows the force of a
// single neighbour fades as it leaves, once differentiable.
template <typename T>
Vec3<T> Mean(const Weighted<T>& sum) {
  const T one(1.0);
  return sum.value / select(sum.weight < one, T(0.5) * (one + sum.weight * sum.weight), sum.weight);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_TERM_H_
