// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/force_posterior.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reconstruct/solve/force_search.h"
#include "tests/reconstruct/coupled_case.h"

namespace flocklift {
namespace {

double MeanOfAll(const std::vector<std::vector<double>>& animals) {
  double sum = 0, count = 0;
  for (const std::vector<double>& animal : animals) {
    for (const double value : animal) sum += value, ++count;
  }
  return sum / count;
}

// Variances where the search leaves sds of `open` [log depth], over what the linearised problem
// says with the rules as they are.
double Widening(const internal::WindowToRefine& window, internal::FollowedFlock flock,
                double open) {
  flock.open.assign(flock.birds.size(), open);
  internal::FollowedFlock same = flock;
  const internal::ForcePosterior posterior = internal::PosteriorOf(window.state.model, &flock);
  EXPECT_EQ(posterior.open.size(), flock.birds.size());
  for (const double variance : posterior.open) EXPECT_NEAR(variance, open * open, 1e-12);
  constexpr int kIterations = 6;  // the posterior's own
  auto sds = same.Settle(window.state.model, kIterations).Depths().at;
  for (auto& animal : sds) {
    for (double& sd : animal) sd *= sd;
  }
  return MeanOfAll(posterior.linear) / MeanOfAll(sds);
}

// Where distances are unsure by more than the length over which rules end, edges say less; where
// they are not, it is as the linearised problem says, but for the factor that is measured.
TEST(ForcePosterior, EdgesAreNoSharperThanDistancesAreKnown) {
  const FlockSpec spec{.count = 8, .frames = 90};
  WithWindow(spec, {}, [&](const internal::WindowToRefine& window) {
    internal::FollowedFlock found = internal::FollowForces({}, window.state);
    const double unsure = Widening(window, found, 0.07);
    EXPECT_GT(unsure, 1.2 * Widening(window, found, 0));
    EXPECT_GT(Widening(window, found, 0.21), 1.2 * unsure);
    found.noise.sd = 0.3;
    EXPECT_NEAR(Widening(window, found, 0), 1.96, 1e-6);
  });
}

}  // namespace
}  // namespace flocklift
