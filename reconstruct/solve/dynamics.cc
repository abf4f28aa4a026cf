// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/dynamics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "reconstruct/solve/box_of_body.h"
#include "reconstruct/solve/common_scale.h"
#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/fingerprint.h"
#include "reconstruct/solve/force_posterior.h"
#include "reconstruct/solve/force_search.h"
#include "reconstruct/solve/hidden_sightings.h"
#include "reconstruct/solve/window_solver.h"
#include "simulate/core/options.h"

namespace flocklift {
namespace {

using namespace internal;  // NOLINT: the method's own parts

// Probability from which on forces count: odds of the root of 10, from which on evidence is
// "substantial" (Jeffreys, Theory of Probability, 1961).
constexpr double kSubstantial = 0.76;
constexpr int kIterations = 350;  // of solvers in a window, about

// Moves `to` by `share` of the way to `from`.
template <typename Values>
void Approach(double share, const Values& from, Values* to) {
  auto target = from.begin();
  for (double& x : *to) x += share * (*target++ - x);
}

// Log depths of two solutions side by side, at every sighting.
struct Both {
  std::vector<std::vector<double>> batch, forces;  // variances, of what is not the common scale
  std::vector<std::vector<double>> off;            // from batch to forces

  // How far to go from one to the other, for the least variance of errors that are correlated:
  // their covariance follows from how far the solutions are apart (Bates and Granger, "The
  // combination of forecasts", 1969). Where that is farther than uncorrelated errors would be, both
  // are less sure than they say, in proportion.
  double LeastVarianceShare() const {
    double of_batch = 0, of_forces = 0, squares = 0;
    for (std::size_t i = 0; i < off.size(); ++i) {
      for (std::size_t k = 0; k < off[i].size(); ++k) {
        of_batch += batch[i][k];
        of_forces += forces[i][k];
        squares += off[i][k] * off[i][k];
      }
    }
    squares = std::min(squares, of_batch + of_forces);
    return squares > 0 ? std::clamp(0.5 + 0.5 * (of_batch - of_forces) / squares, 0.0, 1.0) : 1;
  }
  // The share of forces in a mixture's variances, what is `open` for an animal with them, and what
  // the two are apart.
  DepthPosterior Mixed(double weight, const std::vector<double>& open) const {
    DepthPosterior posterior{weight, forces};
    for (std::size_t i = 0; i < off.size(); ++i) {
      for (std::size_t k = 0; k < off[i].size(); ++k) {
        double& value = posterior.variances[i][k];
        value = weight * (value + open[i] + (1 - weight) * off[i][k] * off[i][k]);
      }
    }
    return posterior;
  }
};

Both SideBySide(const WindowToRefine& window, const ForcePosterior& posterior,
                const std::vector<Bird>& flock) {
  Both both{window.variances(), posterior.linear, posterior.linear};
  for (std::size_t i = 0; i < flock.size(); ++i) {
    for (std::size_t k = 0; k < flock[i].places.size(); ++k) {
      const Bird::Place& place = flock[i].places[k];
      double off = 0;
      for (std::size_t a = 0; a < 4; ++a) {
        const std::size_t at = 3 * (static_cast<std::size_t>(place.interval) + a) + 2;
        off += place.weights[a] * (flock[i].path[at] - window.state.birds[i].path[at]);
      }
      both.off[i][k] = off;
    }
  }
  return both;
}

// Which of two solutions predicts hidden sightings better.
struct Test {
  std::vector<double> batch_errors, errors;  // by piece
  double odds = 1;                           // before
  long count = 0;                            // of sightings

  // Small flocks have few pieces in one fold. No sighting is hidden twice.
  bool WantsMore(int folds, double share) const {
    constexpr std::size_t kEnough = 60;
    return errors.size() < kEnough && (folds + 1) * share <= 1 + 1e-9;
  }
  void AddBatch(const HiddenSightings& hidden, const BatchState& masked) {
    const auto more = hidden.ErrorsOf(masked.birds, masked.model.knot_interval);
    batch_errors.insert(batch_errors.end(), more.begin(), more.end());
    count += hidden.count();
  }
  void AddForces(const HiddenSightings& hidden, const BatchState& masked,
                 const FollowedFlock& flock) {
    const auto more = hidden.ErrorsOf(flock.birds, masked.model.knot_interval);
    errors.insert(errors.end(), more.begin(), more.end());
  }
};

// Birds on the paths of others of the same knots that had other sightings.
std::vector<Bird> OnPathsOf(std::vector<Bird> birds, const std::vector<Bird>& others) {
  for (std::size_t i = 0; i < birds.size(); ++i) {
    birds[i].path = others[i].path;
    birds[i].own = others[i].own;
  }
  return birds;
}

// Another fold's start: who is how far away is known from `flock`, as forces and noise are. Where
// animals are in the picture is not: `flock` has seen what this fold hides.
FollowedFlock StartOf(const BatchState& masked, const FollowedFlock& flock) {
  FollowedFlock start = flock;
  start.birds = OnPathsOf(masked.birds, flock.birds);
  for (std::size_t i = 0; i < start.birds.size(); ++i) {
    const std::vector<double>& seen = masked.birds[i].path;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      if (k % 3 != 2) start.birds[i].path[k] = seen[k];
    }
  }
  return start;
}

// Boxes relate to the wingspan otherwise where animals turn out to fly otherwise, so far as they
// are boxes of bodies.
BatchModel ModelOf(const FollowedFlock& flock, const WindowToRefine& window) {
  BatchModel model = window.state.model;
  if (!(model.body.share > 0)) return model;
  const auto ratio = [&](const std::vector<Bird>& birds, const Eigen::VectorXd& shared) {
    return ExpectedBoxRatio(model, birds, shared, 0).mean;
  };
  model.size_ratio.mean += model.body.share * (ratio(flock.birds, flock.shared) -
                                               ratio(window.state.birds, window.state.shared));
  return model;
}

void Describe(const FollowedFlock& flock, DynamicsReport* report) {
  FlockForces f;
  f.unknowns = flock.forces;
  report->forces = {
      {"d_s", f[kLogDs]},         {"d_v", f[kLogDv]},           {"taper", f[kLogTaper]},
      {"alpha_s", f[kLogAlphaS]}, {"alpha_c", f[kLogAlphaC]},   {"alpha_a", f[kLogAlphaA]},
      {"cruise", f[kLogCruise]},  {"drive", f[kLogDrive]},      {"level", f[kLogLevel]},
      {"goal", f[kLogGoal]},      {"goal_range", f[kLogRange]}, {"noise", flock.noise.sd}};
}

std::uint64_t FingerprintOf(const DynamicsOptions& options) {
  Hash hash;
  hash.Add(std::string_view("dynamics"));
  DynamicsOptions described = options;
  Describe(hash, described);
  return hash.value();
}

}  // namespace

BatchResult SolveDynamics(const DynamicsOptions& options, const BatchOptions& batch_options,
                          const Knowledge& knowledge, const Segments& segments, double fps,
                          int threads, const Progress& progress,
                          const std::filesystem::path& checkpoint) {
  CheckOptions(options);
  const WindowRefiner refine = [&](const WindowToRefine& window) {
    if (window.state.model.erratic) return;  // the flock's forces are of animals that fly on
    Test test;
    FollowedFlock flock;
    for (int fold = 0; fold == 0 || test.WantsMore(fold, options.hidden); ++fold) {
      const HiddenSightings hidden(options.hidden, options.hidden_time, fps, window.segments, fold);
      if (hidden.count() == 0) {
        if (fold == 0) return;
        continue;
      }
      const BatchState masked =
          SolveAgain(window.state, hidden.rest(), batch_options.max_iterations, threads);
      test.AddBatch(hidden, masked);
      if (fold == 0) {
        flock = FollowForces(options, masked);
        const double less = masked.model.spreads.acceleration.sd / flock.noise.sd;
        test.odds = less * less;
        test.AddForces(hidden, masked, flock);
      } else {
        FollowedFlock other = StartOf(masked, flock);
        Settle(masked.model, &other);
        test.AddForces(hidden, masked, other);
      }
      if (fold == 0) flock.birds = OnPathsOf(window.state.birds, flock.birds);
    }
    DynamicsReport& report = *window.report;
    report.windows = 1;
    report.hidden = test.count;
    report.batch_error = MeanOf(test.batch_errors);
    report.dynamics_error = MeanOf(test.errors);
    const double better = ProbabilityOfBetter(test.errors, test.batch_errors, test.odds);
    if (!(better > kSubstantial)) return;
    const ForcePosterior posterior = PosteriorOf(window.state.model, &flock);
    FindCommonScale(ModelOf(flock, window), &flock.birds, &flock.shared);
    if (posterior.linear.empty()) return;
    const Both both = SideBySide(window, posterior, flock.birds);
    const double weight = better * both.LeastVarianceShare();
    if (!(weight > 0)) return;
    report.kept = 1;
    report.weight = weight;
    *window.posterior = both.Mixed(weight, posterior.open);
    for (std::size_t i = 0; i < flock.birds.size(); ++i) {
      Approach(weight, flock.birds[i].path, &window.state.birds[i].path);
      Approach(weight, flock.birds[i].own, &window.state.birds[i].own);
    }
    Approach(weight, flock.shared, &window.state.shared);
    Describe(flock, &report);
  };
  return SolveBatch(batch_options, knowledge, segments, fps, threads, progress, checkpoint,
                    {refine, FingerprintOf(options), kIterations});
}

}  // namespace flocklift
