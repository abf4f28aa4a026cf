// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A flock that circles in view, solved by the batch method, for tests of what goes on from there.

#ifndef FLOCKLIFT_TESTS_RECONSTRUCT_COUPLED_CASE_H_
#define FLOCKLIFT_TESTS_RECONSTRUCT_COUPLED_CASE_H_

#include <gtest/gtest.h>

#include <optional>

#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/window_solver.h"
#include "tests/reconstruct/circling_flock.h"

namespace flocklift {

inline constexpr double kFps = 30;

inline Knowledge Known(const FlockSpec& spec) {
  Knowledge knowledge;
  knowledge.speed = Uncertain{spec.speed, 0.1 * spec.speed};
  knowledge.wingspan = Uncertain{spec.wingspan, 0.05 * spec.wingspan};
  return knowledge;
}

inline Segments Seen(const FlockSpec& spec) {
  const Camera camera = WatchingCamera();
  return MakeSegments({}, Observe(spec, {}, CirclingFlock(spec), camera), camera, kFps);
}

// Calls with a batch solution, as a refiner would be.
template <typename Check>
void WithWindow(const FlockSpec& spec, const BatchOptions& options, const Check& check) {
  int asked = 0;
  internal::SolveWindow(options, Known(spec), Seen(spec), std::nullopt, 1, kFps, 1, {},
                        [&](const internal::WindowToRefine& window) {
                          ++asked;
                          check(window);
                        });
  EXPECT_EQ(asked, 1);
}

// Calls with the coupled flock of one.
template <typename Check>
void WithFlock(const FlockSpec& spec, const BatchOptions& options, const Check& check) {
  WithWindow(spec, options, [&](const internal::WindowToRefine& window) {
    internal::CoupledFlock flock(window.state.model, &window.state.birds, &window.state.shared);
    check(window, flock);
  });
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_RECONSTRUCT_COUPLED_CASE_H_
