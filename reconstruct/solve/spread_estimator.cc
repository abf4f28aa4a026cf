// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/spread_estimator.h"

#include <algorithm>
#include <cmath>

namespace flocklift::internal {
namespace {

// What a first guess is worth, in animals. The width of the flock, which is seen, tells its depth
// better than depths do.
constexpr double kGuessWorth = 4, kWidthWorth = 30;

ResidualRow Combine(double factor, const ResidualRow& a, const ResidualRow& b) {
  ResidualRow row = a;
  row.residual = b.residual + factor * a.residual;
  for (double& derivative : row.path) derivative *= factor;
  for (std::size_t k = 3; k < row.path.size(); ++k) row.path[k] += b.path[k - 3];
  for (int k = 0; k < row.border_count; ++k) row.border[k].second *= factor;
  for (int k = 0; k < b.border_count; ++k) row.AddBorder(b.border[k].first, b.border[k].second);
  return row;
}

}  // namespace

ErrorPair::ErrorPair(const ResidualRow& a, const ResidualRow& b)
    : sum(Combine(1, a, b)), difference(Combine(-1, a, b)) {}

void SpreadEstimator::BeginAnimal(double duration) {
  constexpr double kWhole = 1;  // [s]
  animals_ += std::min(1.0, duration / kWhole);
  seconds_ += duration;
}

void SpreadEstimator::Add(Term term, double error, double variance) {
  const std::size_t k = static_cast<std::size_t>(term);
  const double sd = SdOf(term);
  // An outlier counts as what the robust loss makes of it.
  const double weight = RobustWeight(term, error / sd);
  squares_[k] += weight * error * error;
  variances_[k] += variance;
  counts_[k] += 1;
}

void SpreadEstimator::AddSizePair(double sum, double sum_variance, double difference,
                                  double difference_variance) {
  const double sd = now_.size.sd;
  const double larger = 0.5 * (std::abs(sum) + std::abs(difference));  // of the two errors
  const double weight = RobustWeight(Term::kSize, larger / sd);
  const double bound = 36 * sd * sd;
  sums_ += weight * sum * sum + std::min(sum_variance, bound);
  differences_ += weight * difference * difference + std::min(difference_variance, bound);
}

void SpreadEstimator::Merge(const SpreadEstimator& other) {
  animals_ += other.animals_;
  seconds_ += other.seconds_;
  sums_ += other.sums_;
  differences_ += other.differences_;
  for (std::size_t k = 0; k < kTermCount; ++k) {
    squares_[k] += other.squares_[k];
    variances_[k] += other.variances_[k];
    counts_[k] += other.counts_[k];
  }
}

void SpreadEstimator::Update(const Spreads& guess, double knot_interval, Spreads* spreads) const {
  const auto update = [&](Term term, double n, double first, double* sd,
                          double worth = kGuessWorth) {
    const std::size_t k = static_cast<std::size_t>(term);
    if (counts_[k] == 0) return;
    const double now = SdOf(term);
    // What is seen of the errors; a posterior wider than the prior is one of outliers.
    const double seen = std::max(0.0, 1 - variances_[k] / (counts_[k] * now * now));
    const double next =
        std::sqrt((n * squares_[k] / counts_[k] + worth * first * first) / (n * seen + worth));
    *sd = std::clamp(next, 0.1 * first, 10 * first);
  };
  const double sizes = std::max(animals_, seconds_ / std::max(2 * now_.size.time, knot_interval));
  update(Term::kAcceleration, animals_, guess.acceleration.sd, &spreads->acceleration.sd);
  update(Term::kSpeed, animals_, guess.speed.sd, &spreads->speed.sd);
  update(Term::kSize, sizes, guess.size.sd, &spreads->size.sd);
  update(Term::kClimb, animals_, guess.climb.sd, &spreads->climb.sd);
  update(Term::kDepth, animals_, guess.depth.sd, &spreads->depth.sd, kWidthWorth);
  update(Term::kSpeedSpread, animals_, guess.speed_between, &spreads->speed_between);
  update(Term::kSizeSpread, animals_, guess.size_between, &spreads->size_between);
  spreads->size_between = std::max(spreads->size_between, guess.size_between);
  update(Term::kTurn, counts_[static_cast<std::size_t>(Term::kTurn)] / 3, guess.turn.sd,
         &spreads->turn.sd);
  if (sums_ + differences_ > 0) {
    const double found = (sums_ - differences_) / (sums_ + differences_);
    const double first = guess.size.Correlation(knot_interval);
    const double next = (animals_ * found + kGuessWorth * first) / (animals_ + kGuessWorth);
    constexpr double kNone = 1e-6;  // errors of one knot tell nothing of the next
    const double time = -knot_interval / std::log(std::max(next, kNone));
    spreads->size.time = std::clamp(time, 0.1 * guess.size.time, 10 * guess.size.time);
  }
}

double SpreadEstimator::SdOf(Term term) const {
  switch (term) {
    case Term::kAcceleration:
      return now_.acceleration.sd;
    case Term::kSpeed:
      return now_.speed.sd;
    case Term::kSize:
      return now_.size.sd;
    case Term::kClimb:
      return now_.climb.sd;
    case Term::kDepth:
      return now_.depth.sd;
    case Term::kSpeedSpread:
      return now_.speed_between;
    case Term::kSizeSpread:
      return now_.size_between;
    case Term::kTurn:
      return now_.turn.sd;
    default:
      return 1;
  }
}

}  // namespace flocklift::internal
