// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/size_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace flocklift::internal {
namespace {

constexpr double kStiffBeforehand = 0.1;
constexpr double kStiffRatioSd = 0.15;
constexpr double kStiffFormSd = 0.1;  // of log trunk and log up: nothing is quite a ball

Eigen::Vector3d MeanOf(const SizeModel& m) {
  return {m.ratio.mean, m.log_trunk.mean, m.log_up.mean};
}

Eigen::Vector3d SdOf(const SizeModel& m) { return {m.ratio.sd, m.log_trunk.sd, m.log_up.sd}; }

Eigen::Matrix3d InformationOf(const SizeModel& m) {
  return SdOf(m).cwiseAbs2().cwiseInverse().asDiagonal();
}

// log of the normal density, of x with this mean and sd.
double LogNormal(double x, double mean, double sd) {
  const double r = (x - mean) / sd;
  return -0.5 * r * r - std::log(sd * std::sqrt(2 * std::numbers::pi));
}

// log of (density of this spread of stiff boxes over that of silhouettes).
double LogStiffByForm(double form_sd) {
  constexpr double kUsual = 0.25, kUsualSd = 0.7;  // of silhouettes; sd of the logarithm
  constexpr double kLeast = 0.01, kMost = 0.1;     // of stiff boxes
  constexpr double kFallOff = 0.25;                // beyond the most, of the logarithm
  const double log_sd = std::log(std::max(form_sd, kLeast));
  const double beyond = std::max(0.0, (log_sd - std::log(kMost)) / kFallOff);
  return -std::log(std::log(kMost / kLeast)) - 0.5 * beyond * beyond -
         LogNormal(log_sd, std::log(kUsual), kUsualSd);
}

Uncertain Mix(double p, const Uncertain& a, const Uncertain& b) {
  const double apart = b.mean - a.mean;
  return {a.mean + p * apart,
          std::sqrt((1 - p) * a.sd * a.sd + p * b.sd * b.sd + p * (1 - p) * apart * apart)};
}

}  // namespace

SizeModel StiffSizes(const BoxForm& form) {
  return {{form.log_diagonal, kStiffRatioSd}, {0, kStiffFormSd}, {0, kStiffFormSd}};
}

SizeLikelihood::SizeLikelihood(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance,
                               const SizeModel& prior) {
  const Eigen::Matrix3d posterior = covariance.inverse();
  information = posterior - InformationOf(prior);
  pull = posterior * mean - InformationOf(prior) * MeanOf(prior);
}

double SizeLikelihood::LogEvidence(const SizeModel& model) const {
  const Eigen::Matrix3d own = InformationOf(model);
  const Eigen::Matrix3d all = information + own;
  const Eigen::Vector3d mean = MeanOf(model);
  const Eigen::Vector3d all_pull = pull + own * mean;
  const double volumes = std::max(all.determinant() / own.determinant(), 1e-300);
  return 0.5 * (all_pull.dot(all.inverse() * all_pull) - mean.dot(own * mean) - std::log(volumes));
}

double ProbabilityOfStiff(const SizeLikelihood& likelihood, const BoxForm& form,
                          const SizeModel& body, const SizeModel& stiff) {
  const double log_odds = std::log(kStiffBeforehand / (1 - kStiffBeforehand)) +
                          LogStiffByForm(form.sd) + likelihood.LogEvidence(stiff) -
                          likelihood.LogEvidence(body);
  const double p = 1 / (1 + std::exp(-log_odds));
  return std::isfinite(p) ? p : kStiffBeforehand;
}

SizeModel Mixture(double stiff_probability, const SizeModel& body, const SizeModel& stiff) {
  return {Mix(stiff_probability, body.ratio, stiff.ratio),
          Mix(stiff_probability, body.log_trunk, stiff.log_trunk),
          Mix(stiff_probability, body.log_up, stiff.log_up)};
}

}  // namespace flocklift::internal
