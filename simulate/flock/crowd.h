// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The animals of one species as minimum-distance enforcement sees them, and the boxes around those
// of several.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_CROWD_H_
#define FLOCKLIFT_SIMULATE_FLOCK_CROWD_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/core/vec3.h"

namespace flocklift {

inline constexpr std::int64_t kCrowdGrain = 512;  // animals a chunk of work

// Where they are, and how much room each keeps.
template <typename T>
struct Crowd {
  std::size_t size = 0;
  T *x = nullptr, *y = nullptr, *z = nullptr;  // [m], moved
  T room = 0;                                  // half of d_min [m]
  const T* body = nullptr;                     // radii, each added to `room`; null: 0 [m]
  T largest_body = 0;                          // none of them is larger; 0: not known [m]

  T RoomOf(std::size_t k) const { return body != nullptr ? room + body[k] : room; }
};

// Two that are nearer than they may be, in the order of whoever sorted them, and from the first to
// the second.
template <typename T>
struct ClosePair {
  std::uint32_t first, second;
  Vec3<T> way;          // [m]
  T squared, distance;  // of the way [m^2], and how far apart they have to be [m]
};

template <typename T>
struct CrowdBox {
  Vec3<T> low, high;  // [m]
};

// For each kCrowdGrain animals of every crowd, crowd after crowd. What is not a number does not
// count; around nobody, high is below low.
template <typename T>
std::vector<CrowdBox<T>> BoxesOf(std::span<const Crowd<T>> crowds, ThreadPool* pool);
template <typename T>
CrowdBox<T> Around(std::span<const CrowdBox<T>> boxes);

extern template std::vector<CrowdBox<float>> BoxesOf(std::span<const Crowd<float>>, ThreadPool*);
extern template std::vector<CrowdBox<double>> BoxesOf(std::span<const Crowd<double>>, ThreadPool*);
extern template CrowdBox<float> Around(std::span<const CrowdBox<float>>);
extern template CrowdBox<double> Around(std::span<const CrowdBox<double>>);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_CROWD_H_
