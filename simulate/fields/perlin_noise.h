// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gradient noise of K. Perlin, "Improving noise", SIGGRAPH 2002, with its analytic gradient, for
// any scalar. In the cell of x with the fractions f in [0, 1)^3 and the corners c in {0, 1}^3:
//   noise(x) = sum_c w_c v_c,    v_c = g_c . (f - c),    w_c = prod_k (c_k ? s(f_k) : 1 - s(f_k))
//   d_k noise = sum_c w_c g_ck + s'(f_k) sum_{c: c_k = 0} w_c^k (v_{c + e_k} - v_c)
// where w_c^k leaves out the factor of axis k and s(u) = 6 u^5 - 15 u^4 + 10 u^3: twice
// continuously differentiable, zero at every lattice point, mean zero, within [-1.04, 1.04].
// Coordinates are in cells. Three noises that share the lattice and differ in their gradients cost
// one hash.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_PERLIN_NOISE_H_
#define FLOCKLIFT_SIMULATE_FIELDS_PERLIN_NOISE_H_

#include <cmath>
#include <cstddef>
#include <utility>

#include "simulate/core/vec3.h"
#include "simulate/fields/lattice.h"

namespace flocklift {

template <typename T>
struct NoiseSample {
  T value;
  Vec3<T> gradient;
};

template <typename T>
T Fade(const T& u) {
  return u * u * u * (u * (T(6.0) * u - T(15.0)) + T(10.0));
}
template <typename T>
T FadeSlope(const T& u) {
  const T v = u * (u - T(1.0));
  return T(30.0) * v * v;
}

// Calls fn(std::integral_constant<int, 0>) ... <int, 7>: corner q has the bits x = q & 1,
// y = q >> 1 & 1, z = q >> 2.
template <typename Function>
[[gnu::always_inline]] inline void ForEachCorner(const Function& fn) {
  [&]<int... q>(std::integer_sequence<int, q...>) __attribute__((always_inline)) {
    (fn(std::integral_constant<int, q>{}), ...);
  }
  (std::make_integer_sequence<int, 8>{});
}

// Everything about a point that its noises share.
template <typename T>
struct NoiseCell {
  typename Lattice<T>::Bits bits[8];  // of the corners
  Vec3<T> from[2];                    // f - c where all c_k are 0, and where all are 1
  Vec3<T> fade_slope;                 // s'(f_k)
  T weight[8];                        // w_c
  T weight_x[2][2], weight_y[2][2], weight_z[2][2];  // w_c^k: [y][z], [x][z], [x][y]
};

// `hash` maps the numbers of a lattice point to its bits.
template <typename T, typename Hash>
[[gnu::always_inline]] inline NoiseCell<T> MakeNoiseCell(const Hash& hash, const Vec3<T>& x) {
  using std::floor;
  using Bits = typename Lattice<T>::Bits;
  const T one(1.0);
  const Vec3<T> low{floor(x.x), floor(x.y), floor(x.z)};
  const Vec3<T> f = x - low;
  const Bits lx = Lattice<T>::Cell(low.x), ly = Lattice<T>::Cell(low.y),
             lz = Lattice<T>::Cell(low.z);
  const Bits cx[2] = {lx, lx + Bits(1U)}, cy[2] = {ly, ly + Bits(1U)}, cz[2] = {lz, lz + Bits(1U)};
  const Vec3<T> high{Fade(f.x), Fade(f.y), Fade(f.z)};
  const T sx[2] = {one - high.x, high.x}, sy[2] = {one - high.y, high.y},
          sz[2] = {one - high.z, high.z};

  NoiseCell<T> cell;
  cell.from[0] = f;
  cell.from[1] = {f.x - one, f.y - one, f.z - one};
  cell.fade_slope = {FadeSlope(f.x), FadeSlope(f.y), FadeSlope(f.z)};
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      cell.weight_x[a][b] = sy[a] * sz[b];
      cell.weight_y[a][b] = sx[a] * sz[b];
      cell.weight_z[a][b] = sx[a] * sy[b];
    }
  }
  ForEachCorner([&](auto q) __attribute__((always_inline)) {
    constexpr int a = q & 1, b = q >> 1 & 1, c = q >> 2;
    cell.bits[q] = hash(cx[a], cy[b], cz[c]);
    cell.weight[q] = cell.weight_z[a][b] * sz[c];
  });
  return cell;
}

// Noise number kNoise, 0 to 2, and its gradient per cell.
template <int kNoise, typename T>
[[gnu::always_inline]] inline NoiseSample<T> NoiseInCell(const NoiseCell<T>& cell) {
  using L = Lattice<T>;
  T v[8];
  T value(0.0);
  Vec3<T> gradient{T(0.0), T(0.0), T(0.0)};
  ForEachCorner([&](auto q) __attribute__((always_inline)) {
    constexpr int a = q & 1, b = q >> 1 & 1, c = q >> 2;
    const Vec3<T> g = L::template DoubledGradient<kNoise>(cell.bits[q]);
    v[q] = L::AddExactProduct(g.x, cell.from[a].x,
                              L::AddExactProduct(g.y, cell.from[b].y, g.z * cell.from[c].z));
    value += cell.weight[q] * v[q];
    gradient.x = L::AddExactProduct(g.x, cell.weight[q], gradient.x);
    gradient.y = L::AddExactProduct(g.y, cell.weight[q], gradient.y);
    gradient.z = L::AddExactProduct(g.z, cell.weight[q], gradient.z);
  });
  Vec3<T> slope{T(0.0), T(0.0), T(0.0)};
  ForEachCorner([&](auto q) __attribute__((always_inline)) {
    constexpr int a = q & 1, b = q >> 1 & 1, c = q >> 2;
    if constexpr (a == 0) slope.x += cell.weight_x[b][c] * (v[q + 1] - v[q]);
    if constexpr (b == 0) slope.y += cell.weight_y[a][c] * (v[q + 2] - v[q]);
    if constexpr (c == 0) slope.z += cell.weight_z[a][b] * (v[q + 4] - v[q]);
  });
  const T half(0.5);
  gradient += Vec3<T>{cell.fade_slope.x * slope.x, cell.fade_slope.y * slope.y,
                      cell.fade_slope.z * slope.z};
  return {half * value, {half * gradient.x, half * gradient.y, half * gradient.z}};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_PERLIN_NOISE_H_
