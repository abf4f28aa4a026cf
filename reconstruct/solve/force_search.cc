// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/force_search.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "reconstruct/solve/depth_moves.h"

namespace flocklift::internal {
namespace {

constexpr int kIterations = 6;  // of Settle, and half of those of forces alone, at most
constexpr std::size_t kFew = 30;
constexpr Effort kRough{.enough = 0.5, .step = {.share = 3e-2, .most = 60}};

// Moves depths by `share` of the way to the flock's mean at every knot, and speeds to its own.
void DrawTogether(double share, FollowedFlock* flock) {
  std::vector<double> sums, counts;
  for (const Bird& bird : flock->birds) {
    const std::size_t first = static_cast<std::size_t>(bird.first_knot), n = bird.path.size() / 3;
    if (sums.size() < first + n) {
      sums.resize(first + n);
      counts.resize(first + n);
    }
    for (std::size_t c = 0; c < n; ++c) {
      sums[first + c] += bird.path[3 * c + 2];
      ++counts[first + c];
    }
  }
  for (Bird& bird : flock->birds) {
    const std::size_t first = static_cast<std::size_t>(bird.first_knot), n = bird.path.size() / 3;
    for (std::size_t c = 0; c < n; ++c) {
      double& depth = bird.path[3 * c + 2];
      depth += share * (sums[first + c] / counts[first + c] - depth);
    }
    double& speed = bird.own[kOwnLogSpeed];
    speed += share * (flock->shared[kFlockLogSpeed] - speed);
  }
}

// Of one step of annealing, at most: with many animals, wrong places of few weigh less.
int AnnealIterations(std::size_t animals) { return animals > kFew ? 5 : 10; }

// How paths and forces are found from where a flock is.
struct Annealing {
  double together = 0;    // share of the way to the flock's mean depth that animals start from
  double separation = 1;  // share of its usual weight until noise is low: below 1, animals pass
                          // through each other to where all else would have them
};

// The noise starts as large as the batch method's accelerations and falls until animals all but
// obey the forces. Then it is estimated from what they leave, `rounds` times in each of two steps;
// where that cannot be told it is the batch method's again.
FollowedFlock Annealed(const DynamicsOptions& options, const BatchModel& model,
                       const Annealing& how, FollowedFlock flock) {
  constexpr double kTight = 0.1, kHarder = 3;
  constexpr double kCalmer = 0.6, kCalmest = 0.08;
  if (how.together > 0) DrawTogether(how.together, &flock);
  CoupledFlock coupled(model, &flock.birds, &flock.shared, flock.scale);
  const double noise = std::max(options.noise_sd, model.spreads.acceleration.sd);
  coupled.noise = {noise, options.noise_time};
  coupled.tightness = kTight;
  const int iterations = AnnealIterations(flock.birds.size());
  const auto settle = [&coupled, iterations] {
    coupled.Minimize(iterations, kRough);
    coupled.Relinearize();
  };
  coupled.HoldSeparation(how.separation);
  coupled.FitForces(2 * kIterations);
  for (; coupled.noise.sd > kCalmest * noise; coupled.noise.sd *= kCalmer) settle();
  if (how.separation < 1) {
    for (double separation = how.separation; separation < 1; separation *= kHarder) {
      coupled.HoldSeparation(separation);
      settle();
    }
    coupled.HoldSeparation(1);
    settle();
  }
  for (const double tightness : {kTight, 1.0}) {
    coupled.tightness = tightness;
    for (int round = 0; round < options.rounds; ++round) {
      coupled.noise.sd = std::max(options.noise_sd, coupled.EstimateNoise().value_or(noise));
      settle();
    }
  }
  coupled.Minimize(iterations);
  flock.Take(coupled);
  return flock;
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

// What is not a number is worse than all others.
bool IsBetter(const FollowedFlock& a, const FollowedFlock& b) {
  if (std::isnan(a.improbable)) return false;
  return std::isnan(b.improbable) || a.improbable < b.improbable;
}

// From the batch solution, two at most. Without sizes that hardly knows who is in front; animals
// that pass through each other take longer the more neighbours there are, so that large flocks have
// time for one.
std::vector<Annealing> Starts(bool sizes, std::size_t animals) {
  constexpr double kSoft = 0.1;
  if (sizes) return {{}};
  if (animals > kFew) return {{.together = 1, .separation = kSoft}};
  return {{.together = 0.5, .separation = kSoft}, {.together = 1, .separation = kSoft}};
}

// How often all animals are tried at other depths, at most. It takes time with the square of their
// number, where the rest of the search takes it with their number.
int Sweeps(std::size_t animals) {
  constexpr std::size_t kMany = 80;
  if (animals > kMany) return 0;
  return animals > kFew ? 1 : 2;
}

}  // namespace

FollowedFlock FollowForces(const DynamicsOptions& options, const BatchState& batch) {
  // What sds are over how far solutions are apart, as measured.
  constexpr double kOfAnnealings = 2.2, kOfStarts = 0.7;
  FollowedFlock start{batch.birds, batch.shared, {}, {}, 0, {}, {}};
  start.scale = CoupledFlock(batch.model, &start.birds, &start.shared).scale();
  FollowedFlock best, other;
  for (const Annealing& how : Starts(batch.model.use_size, start.birds.size())) {
    FollowedFlock flock = Annealed(options, batch.model, how, start);
    if (best.birds.empty() || IsBetter(flock, best)) std::swap(flock, best);
    if (!flock.birds.empty()) other = std::move(flock);
  }
  FollowedFlock again = Annealed(options, batch.model, {}, best);
  if (IsBetter(again, best)) std::swap(again, best);
  const int sweeps = Sweeps(best.birds.size());
  if (sweeps > 0) best.Settle(batch.model, AnnealIterations(best.birds.size()));
  for (int sweep = 0; sweep < sweeps && MoveDepths(batch.model, &best) > 0; ++sweep) {
  }
  if (batch.model.use_size && best.birds.size() <= kFew) {
    // Where the batch method was right, annealing may have left the better place.
    FollowedFlock direct = start;
    direct.forces = best.forces;
    direct.noise = best.noise;
    direct.Settle(batch.model, 6 * kIterations, best.improbable);
    if (IsBetter(direct, best)) std::swap(direct, best);
  }
  best.open = Apart(best.birds, again.birds);
  for (double& sd : best.open) sd *= kOfAnnealings;
  if (!other.birds.empty()) {
    const std::vector<double> apart = Apart(best.birds, other.birds);
    for (std::size_t i = 0; i < apart.size(); ++i) {
      best.open[i] = std::max(best.open[i], kOfStarts * apart[i]);
    }
  }
  return best;
}

void Settle(const BatchModel& model, FollowedFlock* flock) { flock->Settle(model, kIterations); }

}  // namespace flocklift::internal
