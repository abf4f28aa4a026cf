// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Flock dynamics on top of the batch method: the forces between the animals are estimated together
// with their paths (force_search.h), with as much noise as they leave. They have to earn their
// place: a part of the sightings is hidden from both, and how well each predicts these tells how
// probable it is that forces are nearer to the truth; before, the odds are the variance of the
// batch method's accelerations over that of what forces leave of them. Where that is substantial
// they count by it (Bayesian model averaging; Hoeting et al., 1999), and so far as they leave
// depths less open than batch does: depths are w times those with forces plus 1 - w times those of
// batch. What is hidden must last longer than an acceleration does, or smoothness alone
// predicts it as well. Small flocks have few sightings to hide: there the test goes on with others
// hidden, until all have been (cross-validation), from depths and forces as they are known by then.
// What is solved without hidden sightings starts from the depths, not the places in the picture, of
// what has seen them. Forces are those of animals that fly on: in erratic flight
// (cost_functions/erratic_flight.h) they are left out.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_DYNAMICS_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_DYNAMICS_H_

#include <filesystem>

#include "reconstruct/solve/batch.h"

namespace flocklift {

struct DynamicsOptions {
  double hidden = 0.2;
  double hidden_time = 2;
  double noise_sd = 0.3;
  double noise_time = 0.7;
  int rounds = 1;
};

template <typename Visitor>
void Describe(Visitor& visit, DynamicsOptions& o) {
  visit("hidden", o.hidden, {.low = 0.01, .high = 0.5}, "",
        "share of the sightings that are hidden at a time to test forces");
  visit("hidden-time", o.hidden_time, {.low = 0.05, .high = 10}, "s",
        "how long an animal is hidden in one piece");
  visit("noise-sd", o.noise_sd, {.low = 0.01, .high = 100}, "m/s^2",
        "least spread of accelerations beyond the forces");
  visit("noise-time", o.noise_time, {.low = 0.01, .high = 100}, "s", "how long these last");
  visit("rounds", o.rounds, {.low = 1, .high = 20}, "",
        "of estimating the noise, in each of two steps that end a search");
}

// The batch method's result, with forces where these count, and BatchReport::dynamics.
BatchResult SolveDynamics(const DynamicsOptions& options, const BatchOptions& batch,
                          const Knowledge& knowledge, const Segments& segments, double fps,
                          int threads, const Progress& progress,
                          const std::filesystem::path& checkpoint = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_DYNAMICS_H_
