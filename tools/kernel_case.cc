// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/kernel_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

// Streams of random numbers (simulate/core/rng.h), by run.
constexpr std::uint32_t kStart = 1, kKicks = 2, kNoise = 3;

Rng StreamOf(std::uint64_t seed, int run, std::uint32_t purpose) {
  return Rng(seed, static_cast<std::uint64_t>(run), purpose);
}

Vec3d Normal(Rng* rng, int dimensions) {
  Vec3d v;
  v.x = rng->Normal();
  if (dimensions > 1) v.y = rng->Normal();
  if (dimensions > 2) v.z = rng->Normal();
  return v;
}

double LennardJones(double r) {
  const double s = 1 / std::max(r, 1.0), s2 = s * s, s8 = s2 * s2 * s2 * s2;
  return 24 * 10.0 * (s8 - 2 * s8 * s2 * s2 * s2);
}

// From `a` to `b` over +- half about `at`.
double Edge(double r, double at, double half, double a, double b) {
  if (r < at - half) return a;
  if (r >= at + half) return b;
  return a + (b - a) * 0.5 * (1 - std::cos(std::numbers::pi * (r - at + half) / (2 * half)));
}

double Opinion(double r, double half) {
  constexpr double kCutoff = std::numbers::sqrt2 / 2;
  return r < 0.85 ? Edge(r, kCutoff, half, 1, 0.1) : Edge(r, 1, half, 0.1, 0);
}

// The right-hand side of all animals.
std::vector<Vec3d> Drive(const KernelSystem& system, const KernelState& state) {
  const std::size_t n = state.x.size();
  std::vector<Vec3d> drive(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vec3d dx = state.x[j] - state.x[i];
      const double r = Norm(dx);
      Vec3d pair = system.attraction(r) * dx;
      if (system.alignment) pair += system.alignment(r) * (state.v[j] - state.v[i]);
      drive[i] += pair;
      drive[j] -= pair;
    }
  }
  return drive;
}

// d(state)/dt.
KernelState Slope(const KernelSystem& system, const KernelState& state) {
  if (system.order == 1) return {Drive(system, state), {}};
  return {state.v, Drive(system, state)};
}

KernelState Along(const KernelState& state, const KernelState& slope, double h) {
  KernelState moved = state;
  for (std::size_t i = 0; i < moved.x.size(); ++i) moved.x[i] += h * slope.x[i];
  for (std::size_t i = 0; i < moved.v.size(); ++i) moved.v[i] += h * slope.v[i];
  return moved;
}

KernelState Step(const KernelSystem& system, const KernelState& state, double h) {
  const KernelState a = Slope(system, state);
  const KernelState b = Slope(system, Along(state, a, h / 2));
  const KernelState c = Slope(system, Along(state, b, h / 2));
  const KernelState d = Slope(system, Along(state, c, h));
  KernelState next = Along(state, a, h / 6);
  next = Along(next, b, h / 3);
  next = Along(next, c, h / 3);
  return Along(next, d, h / 6);
}

}  // namespace

const std::vector<KernelSystem>& KernelSystems() {
  static const std::vector<KernelSystem> systems = {
      {.name = "lennard-jones",
       .attraction = [](double r) { return LennardJones(r) / 7; },
       .alignment = {},
       .seen_end = 0.01,
       .last_end = 0.5,
       .frames = 101,
       .runs = 1000},
      {.name = "opinion",
       .dimensions = 1,
       .animals = 10,
       .attraction = [](double r) { return Opinion(r, 0.05) / 10; },
       .alignment = {},
       .spread = 10,
       .is_box = true,
       .seen_end = 15,
       .last_end = 30,
       .frames = 200,
       .runs = 50,
       .substeps = 20},
      {.name = "opinion-steps",
       .dimensions = 1,
       .animals = 10,
       .attraction = [](double r) { return Opinion(r, 0) / 10; },
       .alignment = {},
       .spread = 10,
       .is_box = true,
       .seen_end = 15,
       .last_end = 30,
       .frames = 200,
       .runs = 50,
       .substeps = 20},
      {.name = "flock",
       .order = 2,
       .dimensions = 3,
       .animals = 15,
       .attraction = [](double r) { return 0.15 * std::exp(-r / 2) - 0.6 * std::exp(-2 * r * r); },
       .alignment = [](double r) { return 0.4 * std::exp(-r / 1.5); },
       .diffusion = 1e-3,
       .speed = 0.5,
       .seen_end = 4,
       .last_end = 6,
       .frames = 200,
       .runs = 20,
       .substeps = 10}};
  return systems;
}

KernelState StartOf(const KernelSystem& system, std::uint64_t seed, int run) {
  Rng rng = StreamOf(seed, run, kStart);
  KernelState state;
  for (int i = 0; i < system.animals; ++i) {
    if (system.is_box) {
      Vec3d x;
      x.x = rng.Uniform(0, system.spread);
      if (system.dimensions > 1) x.y = rng.Uniform(0, system.spread);
      if (system.dimensions > 2) x.z = rng.Uniform(0, system.spread);
      state.x.push_back(x);
    } else {
      state.x.push_back(system.spread * Normal(&rng, system.dimensions));
    }
    if (system.order == 2) state.v.push_back(system.speed * Normal(&rng, system.dimensions));
  }
  return state;
}

std::vector<KernelState> Fly(const KernelSystem& system, const KernelState& start, int frames,
                             std::uint64_t seed, int run) {
  Rng rng = StreamOf(seed, run, kKicks);
  const double h = system.dt() / system.substeps;
  const double kick = std::sqrt(2 * system.diffusion * h);
  std::vector<KernelState> states = {start};
  KernelState state = start;
  for (int frame = 1; frame < frames; ++frame) {
    for (int k = 0; k < system.substeps; ++k) {
      state = Step(system, state, h);
      if (kick == 0) continue;
      for (Vec3d& moved : system.order == 1 ? state.x : state.v) {
        moved += kick * Normal(&rng, system.dimensions);
      }
    }
    states.push_back(state);
  }
  return states;
}

Trajectories Seen(const KernelSystem& system, const std::vector<KernelState>& states, double noise,
                  std::uint64_t seed, int run) {
  Rng rng = StreamOf(seed, run, kNoise);
  Trajectories seen;
  seen.fps = system.fps();
  for (int i = 0; i < system.animals; ++i) {
    Trajectory& trajectory = seen.trajectories.emplace_back();
    trajectory.id = i + 1;
    for (std::size_t k = 0; k < states.size(); ++k) {
      TrajectoryPoint point;
      point.frame = static_cast<int>(k) + 1;
      point.position =
          states[k].x[static_cast<std::size_t>(i)] + noise * Normal(&rng, system.dimensions);
      trajectory.points.push_back(point);
    }
  }
  return seen;
}

}  // namespace flocklift
