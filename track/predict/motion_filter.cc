// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/predict/motion_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace flocklift {
namespace {

constexpr double kLeastWeight = 1e-6;  // of a mode, to the best one

// Mean and covariance of a mixture; the covariance, one for both axes, takes the mean of the axes'
// spreads.
MotionState MomentMatched(std::span<const MotionState> modes, std::span<const double> weights) {
  MotionState mean{};
  for (std::size_t m = 0; m < modes.size(); ++m) {
    mean.position.x += weights[m] * modes[m].position.x;
    mean.position.y += weights[m] * modes[m].position.y;
    mean.velocity.x += weights[m] * modes[m].velocity.x;
    mean.velocity.y += weights[m] * modes[m].velocity.y;
    mean.acceleration.x += weights[m] * modes[m].acceleration.x;
    mean.acceleration.y += weights[m] * modes[m].acceleration.y;
  }
  for (std::size_t m = 0; m < modes.size(); ++m) {
    const MotionState& s = modes[m];
    const double px = s.position.x - mean.position.x, py = s.position.y - mean.position.y;
    const double vx = s.velocity.x - mean.velocity.x, vy = s.velocity.y - mean.velocity.y;
    const double ax = s.acceleration.x - mean.acceleration.x;
    const double ay = s.acceleration.y - mean.acceleration.y;
    mean.pp += weights[m] * (s.pp + 0.5 * (px * px + py * py));
    mean.pv += weights[m] * (s.pv + 0.5 * (px * vx + py * vy));
    mean.vv += weights[m] * (s.vv + 0.5 * (vx * vx + vy * vy));
    mean.pa += weights[m] * (s.pa + 0.5 * (px * ax + py * ay));
    mean.va += weights[m] * (s.va + 0.5 * (vx * ax + vy * ay));
    mean.aa += weights[m] * (s.aa + 0.5 * (ax * ax + ay * ay));
  }
  return mean;
}

}  // namespace

MotionFilter::MotionFilter(const MotionState& start) {
  modes_.fill(start);
  for (int m = 0; m < kModes; ++m) modes_[m].aa *= kFactors[m] * kFactors[m];
  mean_ = MomentMatched(modes_, weights_);
}

void MotionFilter::Mix() {
  constexpr double kLeave = (1 - kStay) / (kModes - 1);
  std::array<MotionState, kModes> mixed;
  std::array<double, kModes> weights;
  for (int m = 0; m < kModes; ++m) {
    std::array<double, kModes> from;
    weights[m] = 0;
    for (int n = 0; n < kModes; ++n) {
      from[n] = (n == m ? kStay : kLeave) * weights_[n];
      weights[m] += from[n];
    }
    for (double& w : from) w /= weights[m];
    mixed[m] = MomentMatched(modes_, from);
  }
  modes_ = mixed;
  weights_ = weights;
}

void MotionFilter::Predict(const MotionStep& step, double q, int frames) {
  static const MotionStep kStraight = StepOf(0);
  for (int frame = 0; frame < frames; ++frame) {
    Mix();
    for (int m = 0; m < kModes; ++m) {
      const bool is_agile = m == kModes - 1;
      flocklift::Predict(&modes_[m], is_agile ? kStraight : step, q * kFactors[m] * kFactors[m]);
    }
  }
  mean_ = MomentMatched(modes_, weights_);
}

void MotionFilter::Update(const Vec2d& z, double r) {
  std::array<double, kModes> squared;
  for (int m = 0; m < kModes; ++m) squared[m] = SquaredInnovation(modes_[m], z, r);
  const double nearest = *std::min_element(squared.begin(), squared.end());
  for (int m = 0; m < kModes; ++m) {
    weights_[m] *= std::exp(-0.5 * (squared[m] - nearest)) / (modes_[m].pp + r);
    flocklift::Update(&modes_[m], z, r);
  }
  const double best = *std::max_element(weights_.begin(), weights_.end());
  double sum = 0;
  for (double& w : weights_) {
    w = std::max(w / best, kLeastWeight);
    sum += w;
  }
  for (double& w : weights_) w /= sum;
  mean_ = MomentMatched(modes_, weights_);
}

double MotionFilter::NegativeLogLikelihood(const Vec2d& z, double r) const {
  std::array<double, kModes> squared;
  for (int m = 0; m < kModes; ++m) squared[m] = SquaredInnovation(modes_[m], z, r);
  const double nearest = *std::min_element(squared.begin(), squared.end());
  double sum = 0;
  for (int m = 0; m < kModes; ++m) {
    sum += weights_[m] * std::exp(-0.5 * (squared[m] - nearest)) / (modes_[m].pp + r);
  }
  return 0.5 * nearest - std::log(sum / (2 * std::numbers::pi));
}

double MotionFilter::agility() const {
  double sum = 0;
  for (int m = 0; m < kModes; ++m) sum += weights_[m] * kFactors[m] * kFactors[m];
  return sum;
}

}  // namespace flocklift
