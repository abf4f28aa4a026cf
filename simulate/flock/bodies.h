// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The animals of one species as the kernels want them: one array per coordinate, padded so that a
// pack may be loaded from any animal on.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_BODIES_H_
#define FLOCKLIFT_SIMULATE_FLOCK_BODIES_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

template <typename T>
struct Bodies {
  static constexpr std::size_t kPadding = 16;  // the widest pack

  std::vector<T> x, y, z;            // [m]
  std::vector<T> vx, vy, vz;         // [m/s]
  std::vector<std::uint32_t> agent;  // which animal this is, 0 .. size - 1; unpadded

  std::size_t size() const { return agent.size(); }
  void Resize(std::size_t n) {
    for (std::vector<T>* column : {&x, &y, &z, &vx, &vy, &vz}) column->resize(n + kPadding);
    agent.resize(n);
  }
  Vec3<T> Position(std::size_t k) const { return {x[k], y[k], z[k]}; }
  Vec3<T> Velocity(std::size_t k) const { return {vx[k], vy[k], vz[k]}; }
  void Set(std::size_t k, const Vec3<T>& position, const Vec3<T>& velocity) {
    x[k] = position.x;
    y[k] = position.y;
    z[k] = position.z;
    vx[k] = velocity.x;
    vy[k] = velocity.y;
    vz[k] = velocity.z;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_BODIES_H_
