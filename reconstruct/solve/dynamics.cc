// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/dynamics.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/hidden_sightings.h"
#include "reconstruct/solve/window_solver.h"
#include "simulate/core/options.h"

namespace flocklift {
namespace {

using namespace internal;  // NOLINT: the method's own parts

constexpr int kIterations = 6;    // of one round, at most
constexpr double kUnsure = 1.35;  // errors over what the linearised posterior says, as measured

struct Flock {
  std::vector<Bird> birds;
  Eigen::VectorXd shared, forces;
  MarkovProcess noise;
  double cost = 0;
};

// Forces and paths from where they are, with the noise that they leave from round to
// round, at first as much as the batch method's accelerations.
void Follow(const DynamicsOptions& options, const BatchModel& model, Flock* flock) {
  CoupledFlock coupled(model, &flock->birds, &flock->shared);
  coupled.noise = {std::max(options.noise_sd, model.spreads.acceleration.sd), options.noise_time};
  coupled.FitForces(2 * kIterations);
  for (int round = 0; round < options.rounds; ++round) {
    coupled.Minimize(kIterations);
    coupled.Relinearize();
    const double sd = coupled.noise.sd;
    coupled.noise.sd =
        std::max(options.noise_sd, std::clamp(coupled.EstimateNoise(), 0.5 * sd, 1.5 * sd));
  }
  coupled.Minimize(kIterations);
  flock->forces = coupled.forces.unknowns;
  flock->noise = coupled.noise;
  flock->cost = coupled.Cost();
}

// The same, but at first with the forces of usual birds: depths that are wrong make all of a
// neighbour's influence look weaker than it is, and weak forces leave them wrong.
void FollowUsual(const BatchModel& model, const MarkovProcess& noise, Flock* flock) {
  constexpr double kTight = 0.1;
  CoupledFlock coupled(model, &flock->birds, &flock->shared);
  coupled.noise = {2 * noise.sd, noise.time};
  coupled.tightness = kTight;
  coupled.FitForces(2 * kIterations);
  coupled.Minimize(kIterations);
  coupled.noise = noise;
  for (const double tightness : {kTight, 1.0}) {
    coupled.tightness = tightness;
    coupled.Relinearize();
    coupled.Minimize(kIterations);
  }
  flock->forces = coupled.forces.unknowns;
  flock->noise = noise;
  flock->cost = coupled.Cost();
}

// Goes on with what is known of forces and noise. Returns how sure depths are then.
CoupledFlock::DepthSds Polish(const BatchModel& model, Flock* flock) {
  CoupledFlock coupled(model, &flock->birds, &flock->shared);
  coupled.forces.unknowns = flock->forces;
  coupled.noise = flock->noise;
  coupled.Relinearize();
  coupled.Minimize(kIterations);
  flock->forces = coupled.forces.unknowns;
  return coupled.Depths();
}

// Where the common scale drifts while forces are found, it is not because forces know it: it stays
// that of the batch solution.
void KeepScale(const std::vector<Bird>& before, const BatchModel& model, Flock* flock) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t k = 2; k < before[i].path.size(); k += 3) {
      sum += flock->birds[i].path[k] - before[i].path[k];
      ++count;
    }
  }
  const double grown = sum / count;
  for (Bird& bird : flock->birds) {
    for (std::size_t k = 2; k < bird.path.size(); k += 3) bird.path[k] -= grown;
    bird.own[kOwnLogSpeed] -= grown;
  }
  flock->shared[kFlockLogSpeed] -= grown;
  flock->shared[kSizeRatio] -= grown;
  for (int k = model.depth.first; k < model.depth.end(); ++k) flock->shared[k] -= grown;
}

// How far the depths of two solutions are apart after one common scale, by animal: halfway to what
// all have in common.
std::vector<double> Apart(const std::vector<Bird>& a, const std::vector<Bird>& b) {
  std::vector<double> sums(a.size()), squares(a.size()), counts(a.size());
  double sum = 0, square = 0, count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 2; k < a[i].path.size(); k += 3) {
      const double off = a[i].path[k] - b[i].path[k];
      sums[i] += off;
      squares[i] += off * off;
      ++counts[i];
    }
    sum += sums[i];
    square += squares[i];
    count += counts[i];
  }
  const double mean = sum / count, common = square / count - mean * mean;
  std::vector<double> apart(a.size());
  for (std::size_t i = 0; i < apart.size(); ++i) {
    const double own = (squares[i] - 2 * mean * sums[i]) / counts[i] + mean * mean;
    apart[i] = std::sqrt(std::max(0.0, 0.5 * (own + common)));
  }
  return apart;
}

struct Followed {
  Flock flock;
  std::vector<double> apart;  // of the solutions from both starts, by animal [log depth]
};

// From the batch solution on, from both starts: which is better is not seen before the end.
Followed FollowForces(const DynamicsOptions& options, const WindowToRefine& window) {
  Flock fitted{*window.birds, *window.shared, {}, {}};
  Flock usual = fitted;
  Follow(options, window.model, &fitted);
  FollowUsual(window.model, fitted.noise, &usual);
  Followed followed;
  followed.apart = Apart(fitted.birds, usual.birds);
  followed.flock = usual.cost < fitted.cost ? std::move(usual) : std::move(fitted);
  return followed;
}

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
  // combination of forecasts", 1969).
  double LeastVarianceShare() const {
    double gain = 0, squares = 0;
    for (std::size_t i = 0; i < off.size(); ++i) {
      for (std::size_t k = 0; k < off[i].size(); ++k) {
        gain += batch[i][k] - forces[i][k];
        squares += off[i][k] * off[i][k];
      }
    }
    return squares > 0 ? std::clamp(0.5 + 0.5 * gain / squares, 0.0, 1.0) : 1;
  }
  // The share of forces in a mixture's variances, and what the two are apart. With forces neither
  // of two starts is sure where these end `apart`.
  DepthPosterior Mixed(double weight, const std::vector<double>& apart) const {
    DepthPosterior posterior{weight, forces};
    for (std::size_t i = 0; i < off.size(); ++i) {
      for (std::size_t k = 0; k < off[i].size(); ++k) {
        double& value = posterior.variances[i][k];
        const double open = kUnsure * apart[i];
        value = weight * (value + open * open + (1 - weight) * off[i][k] * off[i][k]);
      }
    }
    return posterior;
  }
};

Both SideBySide(const WindowToRefine& window, const CoupledFlock::DepthSds& sds,
                const std::vector<Bird>& flock) {
  Both both{window.variances(), sds.at, sds.at};
  for (std::size_t i = 0; i < flock.size(); ++i) {
    for (std::size_t k = 0; k < flock[i].places.size(); ++k) {
      const double sd = kUnsure * sds.at[i][k];
      both.forces[i][k] = sd * sd;
      const Bird::Place& place = flock[i].places[k];
      double off = 0;
      for (std::size_t a = 0; a < 4; ++a) {
        const std::size_t at = 3 * (static_cast<std::size_t>(place.interval) + a) + 2;
        off += place.weights[a] * (flock[i].path[at] - (*window.birds)[i].path[at]);
      }
      both.off[i][k] = off;
    }
  }
  return both;
}

void Describe(const Flock& flock, DynamicsReport* report) {
  FlockForces f;
  f.unknowns = flock.forces;
  report->forces = {
      {"d_s", f[kLogDs]},         {"d_v", f[kLogDv]},           {"taper", f[kLogTaper]},
      {"alpha_s", f[kLogAlphaS]}, {"alpha_c", f[kLogAlphaC]},   {"alpha_a", f[kLogAlphaA]},
      {"cruise", f[kLogCruise]},  {"drive", f[kLogDrive]},      {"level", f[kLogLevel]},
      {"goal", f[kLogGoal]},      {"goal_range", f[kLogRange]}, {"noise", flock.noise.sd}};
}

}  // namespace

DynamicsResult SolveDynamics(const DynamicsOptions& options, const BatchOptions& batch_options,
                             const Knowledge& knowledge, const Segments& segments, double fps,
                             int threads, const Progress& progress) {
  CheckOptions(options);
  DynamicsResult result;
  DynamicsReport& report = result.report;
  double batch_sum = 0, dynamics_sum = 0;
  const WindowRefiner refine = [&](const WindowToRefine& window) {
    const HiddenSightings hidden(options.hidden, options.hidden_time, fps, window.segments);
    if (hidden.count() == 0) return;
    ++report.windows;
    std::vector<double> batch_errors, errors;
    Followed followed;
    Flock& flock = followed.flock;
    SolveWindow(batch_options, knowledge, hidden.rest(), window.belief, window.first_frame, fps,
                threads, {}, [&](const WindowToRefine& masked) {
                  batch_errors = hidden.ErrorsOf(*masked.birds, masked.model.knot_interval);
                  followed = FollowForces(options, masked);
                  errors = hidden.ErrorsOf(flock.birds, masked.model.knot_interval);
                });
    report.hidden += hidden.count();
    batch_sum += MeanOf(batch_errors) * static_cast<double>(hidden.count());
    dynamics_sum += MeanOf(errors) * static_cast<double>(hidden.count());
    const double better = ProbabilityOfBetter(errors, batch_errors);
    if (!(better > 0.5)) return;
    // The same knots: what is hidden lies between sightings.
    std::vector<Bird> birds = *window.birds;
    for (std::size_t i = 0; i < birds.size(); ++i) {
      birds[i].path = flock.birds[i].path;
      birds[i].own = flock.birds[i].own;
    }
    flock.birds = std::move(birds);
    const CoupledFlock::DepthSds sds = Polish(window.model, &flock);
    KeepScale(*window.birds, window.model, &flock);
    if (sds.at.empty()) return;
    const Both both = SideBySide(window, sds, flock.birds);
    const double weight = better * both.LeastVarianceShare();
    if (!(weight > 0)) return;
    ++report.kept;
    report.weight += weight;
    *window.posterior = both.Mixed(weight, followed.apart);
    for (std::size_t i = 0; i < flock.birds.size(); ++i) {
      Approach(weight, flock.birds[i].path, &(*window.birds)[i].path);
      Approach(weight, flock.birds[i].own, &(*window.birds)[i].own);
    }
    Approach(weight, flock.shared, window.shared);
    Describe(flock, &report);
  };
  result.batch = SolveBatch(batch_options, knowledge, segments, fps, threads, progress, {}, refine);
  if (report.kept > 0) report.weight /= report.kept;
  if (report.hidden > 0) {
    report.batch_error = batch_sum / static_cast<double>(report.hidden);
    report.dynamics_error = dynamics_sum / static_cast<double>(report.hidden);
  }
  return result;
}

}  // namespace flocklift
