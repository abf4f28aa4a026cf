// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/hidden_sightings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "tests/reconstruct/coupled_case.h"

namespace flocklift {
namespace {

TEST(HiddenSightings, HidesItsShareInPiecesBetweenSightings) {
  const Segments all = Seen({.count = 8, .frames = 240});
  const internal::HiddenSightings hidden(0.1, 0.5, kFps, all);
  long kept = 0, whole = 0;
  for (std::size_t i = 0; i < all.segments.size(); ++i) {
    const auto& before = all.segments[i].sightings;
    const auto& after = hidden.rest().segments[i].sightings;
    EXPECT_EQ(before.front().frame, after.front().frame);
    EXPECT_EQ(before.back().frame, after.back().frame);
    kept += static_cast<long>(after.size());
    whole += static_cast<long>(before.size());
    for (std::size_t k = 1; k < after.size(); ++k) {
      EXPECT_LE(after[k].frame - after[k - 1].frame, 16);
    }
  }
  EXPECT_EQ(kept + hidden.count(), whole);
  EXPECT_NEAR(static_cast<double>(hidden.count()) / static_cast<double>(whole), 0.09, 0.04);
  EXPECT_EQ(hidden.rest().rows, kept);
}

TEST(HiddenSightings, FoldsHideAllButTheEndsOnce) {
  const Segments all = Seen({.count = 8, .frames = 240});
  std::vector<std::map<int, int>> hidden(all.segments.size());  // how often, by frame
  for (int fold = 0; fold < 4; ++fold) {
    const internal::HiddenSightings test(0.25, 1, kFps, all, fold);
    EXPECT_GE(test.pieces(), 8U);
    for (std::size_t i = 0; i < hidden.size(); ++i) {
      for (const Sighting& s : all.segments[i].sightings) ++hidden[i][s.frame];
      for (const Sighting& s : test.rest().segments[i].sightings) --hidden[i][s.frame];
    }
  }
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    const auto& sightings = all.segments[i].sightings;
    for (const auto& [frame, times] : hidden[i]) {
      const bool inside =
          frame > sightings.front().frame + kFps / 2 && frame < sightings.back().frame - kFps / 2;
      EXPECT_EQ(times, inside ? 1 : 0) << i << " " << frame;
    }
  }
}

// Solved again without them, from a solution that saw them: where in the picture that was is
// forgotten, and what comes out is a minimum of what is left.
TEST(HiddenSightings, AreNotKnownToWhatIsSolvedAgain) {
  WithWindow({.count = 5, .frames = 120}, {}, [](const internal::WindowToRefine& window) {
    const internal::HiddenSightings hidden(0.25, 1, kFps, window.segments);
    internal::BatchState elsewhere = window.state;
    for (internal::Bird& bird : elsewhere.birds) {
      for (std::size_t k = 0; k < bird.path.size(); ++k) {
        if (k % 3 != 2) bird.path[k] += 0.1 * std::sin(static_cast<double>(k));
      }
      for (Vec3d& curve : bird.curve) curve += Vec3d{0.1, 0.2, 0.3};
    }
    constexpr int kIterations = 100;
    internal::BatchState again = internal::SolveAgain(window.state, hidden.rest(), kIterations, 1);
    const auto other = internal::SolveAgain(elsewhere, hidden.rest(), kIterations, 1);
    for (std::size_t i = 0; i < again.birds.size(); ++i) {
      EXPECT_EQ(again.birds[i].path, other.birds[i].path) << i;
    }
    const double interval = again.model.knot_interval;
    EXPECT_GT(internal::MeanOf(hidden.ErrorsOf(again.birds, interval)),
              1.2 * internal::MeanOf(hidden.ErrorsOf(window.state.birds, interval)));
    internal::BatchSolver solver(&again, 1);
    const double cost = solver.Cost();
    int iterations = 0;
    solver.Minimize(kIterations, {.fall = 0, .times = 5}, &iterations);
    EXPECT_NEAR(solver.Cost(), cost, 0.02);
  });
}

// Nor does a second camera see them meanwhile.
TEST(HiddenSightings, AreHiddenFromAllCameras) {
  Segments all = Seen({.count = 3, .frames = 240});
  for (Segment& segment : all.segments) {
    for (const Sighting& s : segment.sightings) {
      segment.views.emplace_back();
      segment.views.back().time = s.time;
    }
  }
  const internal::HiddenSightings hidden(0.25, 1, kFps, all);
  for (std::size_t i = 0; i < all.segments.size(); ++i) {
    const Segment& rest = hidden.rest().segments[i];
    std::set<double> seen;
    for (const Sighting& s : rest.sightings) seen.insert(s.time);
    EXPECT_LT(rest.views.size(), all.segments[i].views.size());
    for (const View& view : rest.views) EXPECT_EQ(seen.count(view.time), 1U) << view.time;
  }
}

TEST(HiddenSightings, BetterIsAsProbableAsTheScalesOfErrorsSay) {
  using internal::ProbabilityOfBetter;
  // Square roots: errors are half as large. Four pieces of two coordinates: odds of 2^8.
  const double root = std::sqrt(0.5);
  EXPECT_NEAR(ProbabilityOfBetter({root, root, root, root}, {1, 1, 1, 1}), 256.0 / 257, 1e-12);
  EXPECT_NEAR(ProbabilityOfBetter({1, 1, 1, 1}, {root, root, root, root}), 1.0 / 257, 1e-12);
  EXPECT_EQ(ProbabilityOfBetter({1, 3, 1}, {2, 1, 2}), 0.5);  // by chance
  // A hair's breadth says nothing, however steady.
  EXPECT_NEAR(ProbabilityOfBetter({1, 1.1, 0.9}, {1.001, 1.101, 0.901}), 0.5, 0.01);
  EXPECT_EQ(ProbabilityOfBetter({}, {}), 0.5);
  EXPECT_NEAR(ProbabilityOfBetter({root, root}, {1, 1}, 3), 48.0 / 49, 1e-12);
  EXPECT_EQ(ProbabilityOfBetter({1, 3, 1}, {2, 1, 2}, 3), 0.75);
}

}  // namespace
}  // namespace flocklift
