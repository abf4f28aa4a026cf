// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Flocks for the tests of this room.

#ifndef FLOCKLIFT_TESTS_SIMULATE_FLOCK_FLOCKS_H_
#define FLOCKLIFT_TESTS_SIMULATE_FLOCK_FLOCKS_H_

#include <algorithm>
#include <string>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/bodies.h"
#include "simulate/flock/engine.h"

namespace flocklift {

struct NamedFlock {
  std::string name;
  std::vector<Vec3d> position, velocity;
};

inline NamedFlock RandomFlock(const std::string& name, int n, const Vec3d& size,
                              std::uint64_t seed) {
  NamedFlock flock{name, {}, {}};
  Rng rng(seed);
  for (int k = 0; k < n; ++k) {
    flock.position.push_back(
        {size.x * rng.Uniform(), size.y * rng.Uniform(), size.z * rng.Uniform()});
    flock.velocity.push_back({5 * rng.Normal(), 5 * rng.Normal(), 5 * rng.Normal()});
  }
  return flock;
}

// Ordinary ones, and those on which neighbour searches fail. Sight is meant to be about 1.
inline std::vector<NamedFlock> ManyFlocks() {
  std::vector<NamedFlock> flocks = {
      RandomFlock("dense", 600, {5, 5, 5}, 1),
      RandomFlock("flat", 300, {12, 9, 0}, 2),
      RandomFlock("line", 100, {0, 40, 0}, 3),
      RandomFlock("sparse", 60, {300, 200, 100}, 4),
      RandomFlock("far from the origin", 200, {4, 4, 4}, 5),
      RandomFlock("one", 1, {1, 1, 1}, 6),
      RandomFlock("all in one place", 40, {0, 0, 0}, 7),
      RandomFlock("two clusters", 200, {2, 2, 2}, 8),
      RandomFlock("lattice", 0, {}, 9),
  };
  for (Vec3d& x : flocks[4].position) x += Vec3d{-3000, 2000, 500};
  for (std::size_t k = 0; k < 100; ++k) flocks[7].position[k] += Vec3d{1e5, -1e5, 3e4};
  Rng rng(10);
  for (int k = 0; k < 343; ++k) {  // neighbours at exactly the distance 1, the rim of a cell
    flocks[8].position.push_back({k % 7 * 1.0, k / 7 % 7 * 1.0, k / 49 * 1.0});
    flocks[8].velocity.push_back({rng.Normal(), rng.Normal(), rng.Normal()});
  }
  return flocks;
}

template <typename T>
Bodies<T> AsBodies(const NamedFlock& flock) {
  Bodies<T> bodies;
  bodies.Resize(flock.position.size());
  for (std::size_t k = 0; k < flock.position.size(); ++k) {
    const Vec3d &x = flock.position[k], &v = flock.velocity[k];
    bodies.Set(k, {static_cast<T>(x.x), static_cast<T>(x.y), static_cast<T>(x.z)},
               {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)});
    bodies.agent[k] = static_cast<std::uint32_t>(k);
  }
  return bodies;
}

// Three rules and nothing else.
inline BoidsParameters<double> PlainRules(double d_s, double d_v, double taper = 0) {
  BoidsParameters<double> p;
  p.d_s = d_s;
  p.d_v = d_v;
  p.alpha_s = 0.7;
  p.alpha_c = 0.3;
  p.alpha_a = 0.4;
  p.alpha_b = p.cruise = p.level = p.noise = 0;
  p.s_min = 0;
  p.s_max = 1e6;
  p.taper = taper;
  return p;
}

inline Swarm AsSwarm(const NamedFlock& flock, const ModelParameters& model) {
  return {"bird", model, flock.position, flock.velocity, {}};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_FLOCK_FLOCKS_H_
