// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boids: the rules of the UCSD assignment (equations.md, section 1) in 2D and 3D, with what makes
// birds of them. One animal's acceleration is
//   a = alpha_s F_s + alpha_c F_c + alpha_a F_a                    (BoidsPairs: its neighbours)
//     + alpha_b F_b + cruise (own speed - |v|) v/|v| - level v_z   (BoidsSelf: the world)
// and attraction, fear and noise are the engine's. Everything is templated on the scalar, so that
// the simulator and the inversion share it.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_BOIDS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_BOIDS_H_

#include <cmath>
#include <string_view>
#include <type_traits>

#include "simulate/core/options.h"
#include "simulate/forces/alignment.h"
#include "simulate/forces/boundary.h"
#include "simulate/forces/cohesion.h"
#include "simulate/forces/level.h"
#include "simulate/forces/separation.h"
#include "simulate/forces/speed.h"
#include "simulate/forces/view.h"

namespace flocklift {

inline constexpr std::string_view kNoiseKinds[] = {"none", "white", "perlin", "curl"};
enum class NoiseKind { kNone, kWhite, kPerlin, kCurl };  // indices of kNoiseKinds

// Defaults: birds of the size of a jackdaw at 10 m/s. Rates are per `time_unit`.
template <typename T>
struct BoidsParameters {
  T d_s{5.0}, d_v{12.0};
  T alpha_s{2.0}, alpha_c{0.05}, alpha_a{0.8}, alpha_b{8.0};
  T s_min{6.0}, s_max{14.0};
  T taper{0.0}, wall_taper{6.0};
  T cruise{1.2}, level{0.5};
  T blind{0.0}, blind_taper{0.0};
  T nearest{0.0};
  T goal_range{15.0};
  T noise{2.5}, noise_time{0.8}, noise_scale{10.0};
  T time_unit{1.0};
  Choice noise_kind{kNoiseKinds, static_cast<int>(NoiseKind::kWhite)};
};

template <typename Visitor, typename T>
void Describe(Visitor& visit, BoidsParameters<T>& p) {
  visit("d_s", p.d_s, {.low = 0}, "m", "separation: animals nearer than this push apart");
  visit("d_v", p.d_v, {.low = 0}, "m",
        "sight: animals nearer than this are cohesion's and alignment's neighbours");
  visit("alpha_s", p.alpha_s, {.low = 0}, "1/s^2", "weight of separation (times the mean offset)");
  visit("alpha_c", p.alpha_c, {.low = 0}, "1/s^2",
        "weight of cohesion (times the offset to the mean position)");
  visit("alpha_a", p.alpha_a, {.low = 0}, "1/s",
        "weight of alignment (times the difference to the mean velocity)");
  visit("alpha_b", p.alpha_b, {.low = 0}, "m/s^2", "push of a wall on what is outside");
  visit("s_min", p.s_min, {.low = 0}, "m/s", "lowest speed");
  visit("s_max", p.s_max, {.low = 0}, "m/s", "highest speed");
  visit("taper", p.taper, {.low = 0}, "m",
        "width of the edges of d_s and d_v; 0: hard, as published");
  visit("wall_taper", p.wall_taper, {.low = 0}, "m",
        "way over which a wall's push sets in; 0: hard, as published");
  visit("cruise", p.cruise, {.low = 0}, "1/s",
        "rate at which each animal returns to its own cruising speed");
  visit("level", p.level, {.low = 0}, "1/s", "damping of climbing and sinking");
  visit("blind", p.blind, {.low = 0, .high = 6.283185307179586}, "rad",
        "angle behind an animal in which it sees no neighbours");
  visit("blind_taper", p.blind_taper, {.low = 0, .high = 2}, "",
        "width of that angle's edge, in its cosine; 0: hard");
  visit("nearest", p.nearest, {.low = 0, .high = 1000}, "",
        "neighbours are that many nearest animals instead of those within d_v; 0: within d_v");
  visit("goal_range", p.goal_range, {.low = 1e-6}, "m",
        "an attraction point pulls as a spring nearer than this, constantly beyond");
  visit("noise_kind", p.noise_kind, {}, "",
        "white: each animal's own, correlated in time; perlin, curl: a field that stands in space");
  visit("noise", p.noise, {.low = 0}, "m/s^2",
        "random acceleration, per axis: standard deviation of white noise, amplitude of a field");
  visit("noise_time", p.noise_time, {.low = 0}, "s",
        "correlation time of white noise; 0: fresh at every step");
  visit("noise_scale", p.noise_scale, {.low = 1e-6}, "m", "edge of a field's lattice cell");
  visit("time_unit", p.time_unit, {.low = 1e-9}, "s", "what the other parameters call a second");
}

// The assignment's own numbers: pixels, and steps of 1/30 s.
inline BoidsParameters<double> AssignmentParameters() {
  return {.d_s = 30,
          .d_v = 150,
          .alpha_s = 0.02,
          .alpha_c = 0.001,
          .alpha_a = 0.03,
          .alpha_b = 0.5,
          .s_min = 5,
          .s_max = 10,
          .taper = 0,
          .wall_taper = 0,
          .cruise = 0,
          .level = 0,
          .blind = 0,
          .blind_taper = 0,
          .nearest = 0,
          .goal_range = 1e6,
          .noise = 0,
          .noise_time = 0,
          .noise_scale = 100,
          .time_unit = 1.0 / 30};
}

// The same parameters with seconds for time units.
template <typename T>
BoidsParameters<T> InSeconds(BoidsParameters<T> p) {
  const T rate = T(1.0) / p.time_unit;
  for (T* per_second : {&p.alpha_a, &p.s_min, &p.s_max, &p.cruise, &p.level}) *per_second *= rate;
  for (T* per_square : {&p.alpha_s, &p.alpha_c, &p.alpha_b, &p.noise}) *per_square *= rate * rate;
  p.noise_time *= p.time_unit;
  p.time_unit = T(1.0);
  return p;
}

// What neighbours do. Taper is T or HardEdge; View is AllRound, or the ViewCone<T, Taper> in which
// an animal has neighbours at all.
template <typename T, typename Taper = T, typename View = AllRound>
struct BoidsPairs {
  typename Separation::Params<T, Taper> separation;
  typename Cohesion::Params<T, Taper> cohesion;
  typename Alignment::Params<T, Taper> alignment;
  View view{};

  struct Shares {
    Share<T> separation, cohesion, alignment;
  };
  struct Sums {
    Weighted<T> separation, cohesion, alignment;

    // Calls add(&sum, share) for each rule.
    template <typename Add>
    void Each(const Shares& shares, const Add& add) {
      add(&separation, shares.separation);
      add(&cohesion, shares.cohesion);
      add(&alignment, shares.alignment);
    }
    Sums& operator+=(const Shares& shares) {
      separation += shares.separation;
      cohesion += shares.cohesion;
      alignment += shares.alignment;
      return *this;
    }
    T Neighbours() const { return cohesion.weight; }
  };

  // The rules of an animal of velocity v.
  BoidsPairs For(const Vec3<T>& v) const {
    BoidsPairs own = *this;
    if constexpr (!std::is_same_v<View, AllRound>) own.view.heading = SoftUnit(v);
    return own;
  }
  Shares Pair(const Vec3<T>& dx, const Vec3<T>& dv) const {
    Shares shares{Separation::Pair(separation, dx, dv), Cohesion::Pair(cohesion, dx, dv),
                  Alignment::Pair(alignment, dx, dv)};
    if constexpr (!std::is_same_v<View, AllRound>) {
      const T seen = Seen(view, dx);
      for (Share<T>* share : {&shares.separation, &shares.cohesion, &shares.alignment}) {
        share->weight *= seen;
      }
    }
    return shares;
  }
  Vec3<T> Finish(const Sums& sums) const {
    return Separation::Finish(separation, sums.separation) +
           Cohesion::Finish(cohesion, sums.cohesion) + Alignment::Finish(alignment, sums.alignment);
  }
};

// Parameters in seconds, of scalar S, to the pair terms of scalar T.
template <typename T, typename Taper = T, typename View = AllRound, typename S>
BoidsPairs<T, Taper, View> MakeBoidsPairs(const BoidsParameters<S>& p, Taper taper,
                                          const View& view = {}) {
  return {{T(p.alpha_s), T(p.d_s), taper},
          {T(p.alpha_c), T(p.d_v), taper},
          {T(p.alpha_a), T(p.d_v), taper},
          view};
}

// Cosine of the half angle that is seen around a blind angle behind [rad].
inline double SightCosine(double blind) { return -std::cos(0.5 * blind); }

// How far a neighbour can be felt [m].
inline double Reach(const BoidsParameters<double>& p) {
  return (p.d_s > p.d_v ? p.d_s : p.d_v) + 0.5 * p.taper;
}

// What the world does to one animal.
template <typename T>
struct BoidsSelf {
  typename Boundary::Params<T> walls;
  typename CruiseSpeed::Params<T> cruise;
  typename Level::Params<T> level;

  Vec3<T> At(const Vec3<T>& x, const Vec3<T>& v) const {
    return Boundary::At(walls, x, v) + CruiseSpeed::At(cruise, x, v) + Level::At(level, x, v);
  }
};

template <typename T, typename S>
BoidsSelf<T> MakeBoidsSelf(const BoidsParameters<S>& p, const Vec3<T>& low, const Vec3<T>& high,
                           const T& cruising_speed) {
  return {{T(p.alpha_b), low, high, T(p.wall_taper)}, {T(p.cruise), cruising_speed}, {T(p.level)}};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_BOIDS_H_
