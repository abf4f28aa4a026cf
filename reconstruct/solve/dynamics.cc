// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/dynamics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/hidden_sightings.h"
#include "reconstruct/solve/window_solver.h"
#include "simulate/core/options.h"

namespace flocklift {
namespace {

using namespace internal;  // NOLINT: the method's own parts

constexpr int kIterations = 8;  // of one turn, at most

// Paths and forces that predict best so far.
struct Best {
  std::vector<double> errors;  // of the hidden pieces
  std::vector<Bird> birds;
  Eigen::VectorXd shared;
  FlockForces forces;
  MarkovProcess noise;
};

// In turns: the forces that explain the paths, the paths that the forces and all else explain.
// Starts with as much noise as the batch solution leaves, and halves it.
Best FollowForces(const DynamicsOptions& options, const HiddenSightings& hidden,
                  const BatchModel& model, std::vector<Bird>* birds, Eigen::VectorXd* shared) {
  CoupledFlock flock(model, birds, shared);
  flock.noise.time = options.noise_time;
  double sd = std::max(options.noise_sd, model.spreads.acceleration.sd);
  Best best;
  double least = 0;
  for (int round = 0; round < options.rounds; ++round) {
    flock.noise.sd = sd;
    flock.FitRadii();
    flock.Minimize(kIterations, {});
    std::vector<double> errors = hidden.ErrorsOf(*birds, model.knot_interval);
    const double mean = MeanOf(errors);
    if (round == 0 || mean < least) {
      least = mean;
      best = {std::move(errors), *birds, *shared, flock.forces, flock.noise};
    }
    sd = std::max(options.noise_sd, 0.5 * sd);
  }
  return best;
}

// Forces know no scale but what their gains and radii, estimated before, remember of it: the common
// scale stays that of the batch solution.
void KeepScale(const std::vector<Bird>& before, std::vector<Bird>* birds, Eigen::VectorXd* shared,
               const BatchModel& model) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < birds->size(); ++i) {
    for (std::size_t k = 2; k < before[i].path.size(); k += 3) {
      sum += (*birds)[i].path[k] - before[i].path[k];
      ++count;
    }
  }
  const double grown = sum / count;
  for (Bird& bird : *birds) {
    for (std::size_t k = 2; k < bird.path.size(); k += 3) bird.path[k] -= grown;
    bird.own[kOwnLogSpeed] -= grown;
  }
  (*shared)[kFlockLogSpeed] -= grown;
  (*shared)[kSizeRatio] -= grown;
  for (int k = model.depth.first; k < model.depth.end(); ++k) (*shared)[k] -= grown;
}

void Describe(const FlockForces& f, DynamicsReport* report) {
  double pull = 0;
  for (const Vec3d& p : f.pull) pull += Norm(p) / static_cast<double>(f.pull.size());
  report->forces = {{"d_s", f.d_s},         {"d_v", f.d_v},         {"alpha_s", f.alpha_s},
                    {"alpha_c", f.alpha_c}, {"alpha_a", f.alpha_a}, {"cruise", f.cruise},
                    {"level", f.level},     {"spring", f.spring},   {"pull", pull}};
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
    std::vector<double> batch_errors;
    Best best;
    SolveWindow(batch_options, knowledge, hidden.rest(), window.belief, window.first_frame, fps,
                threads, {}, [&](const WindowToRefine& masked) {
                  batch_errors = hidden.ErrorsOf(*masked.birds, masked.model.knot_interval);
                  best = FollowForces(options, hidden, masked.model, masked.birds, masked.shared);
                });
    report.hidden += hidden.count();
    batch_sum += MeanOf(batch_errors) * static_cast<double>(hidden.count());
    dynamics_sum += MeanOf(best.errors) * static_cast<double>(hidden.count());
    if (!PredictsBetter(best.errors, batch_errors)) return;
    ++report.kept;
    Describe(best.forces, &report);
    const std::vector<Bird> of_batch = *window.birds;
    // The same knots: what is hidden lies between sightings.
    for (std::size_t i = 0; i < best.birds.size(); ++i) {
      (*window.birds)[i].path = best.birds[i].path;
      (*window.birds)[i].own = best.birds[i].own;
    }
    *window.shared = best.shared;
    CoupledFlock flock(window.model, window.birds, window.shared);
    flock.forces = best.forces;
    flock.noise = best.noise;
    flock.FreezeNeighbours();
    flock.Minimize(kIterations, {});
    flock.FitGains();
    flock.Minimize(kIterations, {});
    KeepScale(of_batch, window.birds, window.shared, window.model);
  };
  result.batch = SolveBatch(batch_options, knowledge, segments, fps, threads, progress, {}, refine);
  if (report.hidden > 0) {
    report.batch_error = batch_sum / static_cast<double>(report.hidden);
    report.dynamics_error = dynamics_sum / static_cast<double>(report.hidden);
  }
  return result;
}

}  // namespace flocklift
