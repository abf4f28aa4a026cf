// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/noise_field.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reconstruct/fit/noise_search.h"

namespace flocklift {
namespace {

constexpr double kOutlier = 5;        // times the robust sd of the rest
constexpr double kNegligible = 0.01;  // of the rms velocity: no reason to leave an animal out
constexpr double kLeastScore = 0.02;  // of its variance with normal gradients
// Of the rms velocity: a velocity over a frame is no nearer to the field's, whatever the likelihood
// of the rest says.
constexpr double kLeastRest = 1e-3;
constexpr int kTrims = 12;
constexpr double kMedianSquare = 2.366;  // of a chi-square variable of three degrees

std::size_t CountOf(const std::vector<VelocitySample>& samples) {
  std::size_t count = 0;
  for (const VelocitySample& sample : samples) count += sample.size();
  return count;
}

void Refine(const std::vector<VelocitySample>& samples, bool with_scale, ScalePlace* place) {
  if (with_scale) {
    const auto profile = [&](double log_scale) {
      const Minimum inner =
          NoiseLikelihood(samples, std::exp(log_scale)).Best(place->log_r, 0.5, 0.1);
      place->log_r = inner.at;
      return inner.value;
    };
    place->log_scale =
        Minimize(profile, place->log_scale, 0.1 * place->spacing, 0.002 * place->spacing).at;
  }
  place->log_r =
      NoiseLikelihood(samples, std::exp(place->log_scale)).Best(place->log_r, 0.5, 0.01).at;
}

std::size_t LeaveOutliersOut(const ScalePlace& place, std::vector<VelocitySample>* samples) {
  std::vector<std::vector<NoiseEvidence::LeftOut>> animals(samples->size());
  std::vector<double> squares;
  for (std::size_t s = 0; s < samples->size(); ++s) {
    if ((*samples)[s].size() == 0) continue;
    animals[s] =
        NoiseEvidence((*samples)[s], std::exp(place.log_scale)).LeaveOneOut(std::exp(place.log_r));
    for (const auto& animal : animals[s]) squares.push_back(animal.standard_square);
  }
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  const double limit = kOutlier * kOutlier * *middle / kMedianSquare;
  const double negligible = kNegligible * kNegligible * MeanSquare(*samples);
  std::size_t left_out = 0;
  for (std::size_t s = 0; s < samples->size(); ++s) {
    VelocitySample kept;
    for (std::size_t k = 0; k < (*samples)[s].size(); ++k) {
      if (animals[s][k].standard_square > limit && animals[s][k].error_square > negligible) {
        ++left_out;
        continue;
      }
      kept.position.push_back((*samples)[s].position[k]);
      kept.velocity.push_back((*samples)[s].velocity[k]);
    }
    (*samples)[s] = std::move(kept);
  }
  return left_out;
}

// H^-1 J H^-1 in (log scale, log gain, log s): H by differences over about a standard deviation.
Eigen::Matrix3d Covariance(const std::vector<VelocitySample>& samples, bool with_scale,
                           NoiseFieldFit fit) {
  fit.rest_sd = std::max(fit.rest_sd, kLeastRest * std::sqrt(MeanSquare(samples)));
  const auto at = [&](double moved) {
    return NoiseLikelihood(samples, fit.scale * std::exp(moved));
  };
  const NoiseLikelihood middle = at(0);
  const double here = middle.Cost(fit.gain, fit.rest_sd);
  double h = 1e-5;
  for (int round = 0; with_scale && round < 3; ++round) {
    const double bend =
        (at(h).Cost(fit.gain, fit.rest_sd) + at(-h).Cost(fit.gain, fit.rest_sd) - 2 * here) /
        (h * h);
    h = bend > 0 ? std::clamp(1 / std::sqrt(bend), 0.1 * h, 10 * h) : 3 * h;
  }
  const NoiseLikelihood low = at(-h), high = at(h);
  const std::array<const NoiseLikelihood*, 3> fields = {&low, &middle, &high};
  const double g = 0.02;
  const auto cost = [&](int a, int b, int c) {
    return fields[static_cast<std::size_t>(a + 1)]->Cost(fit.gain * std::exp(g * b),
                                                         fit.rest_sd * std::exp(g * c));
  };
  const double step[3] = {h, g, g};
  const auto moved = [&](int i, int si, int j, int sj) {
    int d[3] = {0, 0, 0};
    d[i] += si;
    d[j] += sj;
    return cost(d[0], d[1], d[2]);
  };
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (int i = with_scale ? 0 : 1; i < 3; ++i) {
    information(i, i) = (moved(i, 1, i, 0) + moved(i, -1, i, 0) - 2 * here) / (step[i] * step[i]);
    for (int j = with_scale ? 0 : 1; j < i; ++j) {
      information(i, j) = information(j, i) =
          (moved(i, 1, j, 1) + moved(i, -1, j, -1) - moved(i, 1, j, -1) - moved(i, -1, j, 1)) /
          (4 * step[i] * step[j]);
    }
  }
  if (!with_scale) information(0, 0) = std::numeric_limits<double>::max();
  Eigen::Matrix3d score = information;
  NoiseEvidence::GainScore gain;
  const double r = fit.gain * fit.gain / (fit.rest_sd * fit.rest_sd);
  for (const NoiseEvidence& part : middle.parts()) {
    const NoiseEvidence::GainScore one = part.ScoreOfGain(r);
    gain.normal += one.normal;
    gain.excess += one.excess;
  }
  score(1, 1) *= std::max(kLeastScore, 1 + gain.excess / gain.normal);
  const Eigen::Matrix3d inverse = information.inverse();
  return inverse * score * inverse;
}

}  // namespace

NoiseFieldFit FitNoiseField(const NoiseFieldOptions& options, std::vector<VelocitySample> samples) {
  NoiseFieldFit fit;
  fit.used = CountOf(samples);
  if (fit.used < kLeastPoints || !(MeanSquare(samples) > 0)) {
    fit.status = NoiseFieldStatus::kTooFew;
    return fit;
  }
  const bool with_scale = !(options.scale > 0);
  ScalePlace place{.log_scale = std::log(options.scale), .log_r = std::log(kFirstRatio)};
  if (with_scale) place = SearchScale(samples, options.coarse_points, options.threads);
  Refine(samples, with_scale, &place);
  for (int trim = 0; trim < kTrims; ++trim) {
    const std::size_t left_out = LeaveOutliersOut(place, &samples);
    fit.left_out += left_out;
    if (left_out == 0) break;
    Refine(samples, false, &place);
  }
  if (fit.left_out > 0) Refine(samples, with_scale, &place);
  fit.used = CountOf(samples);

  const NoiseLikelihood field(samples, std::exp(place.log_scale));
  const double r = std::exp(place.log_r);
  fit.scale = std::exp(place.log_scale);
  fit.rest_sd = field.RestSd(r);
  fit.gain = std::sqrt(r) * fit.rest_sd;
  double rest = 0;
  for (const NoiseEvidence& part : field.parts()) rest += part.Residual(r).squaredNorm();
  fit.explained = 1 - rest / (MeanSquare(samples) * static_cast<double>(fit.used));
  if (place.at_edge) fit.status = NoiseFieldStatus::kAtEdge;
  if (!(r > 10 * kLeastRatio)) fit.status = NoiseFieldStatus::kNothing;
  const Eigen::Matrix3d covariance = Covariance(samples, with_scale, fit);
  const double scale_variance = with_scale ? covariance(0, 0) : 0;
  fit.scale_sd = fit.scale * std::sqrt(std::max(0.0, scale_variance));
  fit.gain_sd = fit.gain * std::sqrt(std::max(0.0, covariance(1, 1)));
  if (scale_variance > 0 && covariance(1, 1) > 0) {
    fit.correlation = covariance(0, 1) / std::sqrt(scale_variance * covariance(1, 1));
  }
  return fit;
}

}  // namespace flocklift
