// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/noise_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "reconstruct/fit/noise_field.h"
#include "simulate/core/parallel_for.h"

namespace flocklift {
namespace {

constexpr double kScaleSpan = 2;      // the first guess is within this factor
constexpr int kExtensions = 2;        // by that factor, when the best is at the end
constexpr double kPhaseStep = 0.12;   // cells that an animal moves in the lattice between scales
constexpr double kLargestStep = 0.1;  // of log scale
constexpr int kPairsTried = 200000;   // of the correlation

// Where the correlation of velocities falls to half, from pairs of animals in bins of distance.
double FirstScale(const std::vector<VelocitySample>& samples) {
  std::vector<std::pair<double, double>> pairs;  // distance, product
  for (const VelocitySample& sample : samples) {
    const std::size_t n = sample.size();
    const std::size_t stride = std::max<std::size_t>(1, n * n / 2 / kPairsTried);
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (count++ % stride != 0) continue;
        pairs.emplace_back(Norm(sample.position[i] - sample.position[j]),
                           Dot(sample.velocity[i], sample.velocity[j]));
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  const double half = 0.5 * MeanSquare(samples);
  const std::size_t bin = std::max<std::size_t>(10, pairs.size() / 400);
  for (std::size_t first = 0; first + bin <= pairs.size(); first += bin) {
    double product = 0;
    for (std::size_t k = first; k < first + bin; ++k) product += pairs[k].second;
    if (product / static_cast<double>(bin) < half) {
      return pairs[first + bin / 2].first / kHalfCorrelation;
    }
  }
  return pairs.empty() ? 1 : pairs.back().first / kHalfCorrelation;
}

double Reach(const std::vector<VelocitySample>& samples) {
  double reach = 0;
  for (const VelocitySample& sample : samples) {
    for (const Vec3d& x : sample.position) {
      reach = std::max({reach, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    }
  }
  return reach;
}

// The best of the scales from exp(low) to exp(high), on thinned samples; at_edge: the first or
// last.
struct Trial {
  ScalePlace place;
  double cost = 0;
};

Trial BestOf(double low, double high, double reach, int threads,
             const std::vector<VelocitySample>& thin) {
  std::vector<Trial> tried;
  for (double at = low; at < high;) {
    const double step = std::min(kLargestStep, kPhaseStep * std::exp(at) / reach);
    tried.push_back({.place = {.log_scale = at, .log_r = std::log(kFirstRatio), .spacing = step}});
    at += step;
  }
  ParallelFor(threads, 0, static_cast<std::int64_t>(tried.size()), 1,
              [&](std::int64_t k, std::int64_t) {
                Trial& trial = tried[static_cast<std::size_t>(k)];
                const NoiseLikelihood field(thin, std::exp(trial.place.log_scale));
                const Minimum best = field.Best(trial.place.log_r, 2, 1);
                trial.place.log_r = best.at;
                trial.cost = best.value;
              });
  const auto best = std::min_element(
      tried.begin(), tried.end(), [](const Trial& a, const Trial& b) { return a.cost < b.cost; });
  best->place.at_edge = best == tried.begin() || best + 1 == tried.end();
  return *best;
}

}  // namespace

Minimum Minimize(const std::function<double(double)>& f, double start, double step,
                 double tolerance) {
  constexpr double kGolden = 0.381966;
  double a = start - step, b = start, c = start + step;
  double fa = f(a), fb = f(b), fc = f(c);
  for (int k = 0; k < 40 && !(fb <= fa && fb <= fc); ++k) {
    const double grow = 1.6 * (c - b);
    if (fa < fc) {
      c = b, fc = fb, b = a, fb = fa;
      a = b - grow, fa = f(a);
    } else {
      a = b, fa = fb, b = c, fb = fc;
      c = b + grow, fc = f(c);
    }
  }
  for (int k = 0; k < 60 && c - a > tolerance; ++k) {
    const double p = (b - a) * (fb - fc), q = (b - c) * (fb - fa);
    const double vertex = std::abs(p - q) > 0 ? b - 0.5 * ((b - a) * p - (b - c) * q) / (p - q) : b;
    const double margin = 0.05 * (c - a);
    double x = vertex;
    if (!(x > a + 0.2 * margin && x < c - 0.2 * margin) || std::abs(x - b) < 0.2 * margin) {
      x = b - a > c - b ? b - kGolden * (b - a) : b + kGolden * (c - b);
    }
    const double fx = f(x);
    if (fx < fb) {
      (x < b ? c : a) = b;
      (x < b ? fc : fa) = fb;
      b = x, fb = fx;
    } else {
      (x < b ? a : c) = x;
      (x < b ? fa : fc) = fx;
    }
  }
  return {b, fb};
}

NoiseLikelihood::NoiseLikelihood(const std::vector<VelocitySample>& samples, double scale) {
  for (const VelocitySample& sample : samples) {
    if (sample.size() == 0) continue;
    parts_.emplace_back(sample, scale);
    equations_ += static_cast<double>(parts_.back().equations());
  }
}

NoiseEvidence::Value NoiseLikelihood::At(double r) const {
  NoiseEvidence::Value sum;
  for (const NoiseEvidence& part : parts_) {
    const NoiseEvidence::Value value = part.At(r);
    sum.log_determinant += value.log_determinant;
    sum.square += value.square;
  }
  return sum;
}

double NoiseLikelihood::Profile(double r) const {
  const NoiseEvidence::Value value = At(r);
  return equations_ * std::log(std::max(value.square, 1e-300) / equations_) + value.log_determinant;
}

Minimum NoiseLikelihood::Best(double log_r, double step, double tolerance) const {
  const double low = std::log(kLeastRatio), high = std::log(kGreatestRatio);
  return Minimize([&](double x) { return Profile(std::exp(std::clamp(x, low, high))); },
                  std::clamp(log_r, low, high), step, tolerance);
}

double NoiseLikelihood::Cost(double gain, double s) const {
  const NoiseEvidence::Value value = At(gain * gain / (s * s));
  return 0.5 * (2 * equations_ * std::log(s) + value.log_determinant + value.square / (s * s));
}

double NoiseLikelihood::RestSd(double r) const { return std::sqrt(At(r).square / equations_); }

double MeanSquare(const std::vector<VelocitySample>& samples) {
  double sum = 0, count = 0;
  for (const VelocitySample& sample : samples) {
    for (const Vec3d& v : sample.velocity) sum += SquaredNorm(v);
    count += static_cast<double>(sample.size());
  }
  return sum / std::max(count, 1.0);
}

VelocitySample Thinned(const VelocitySample& sample, std::size_t points) {
  const std::size_t n = sample.size(), m = std::min(n, points);
  VelocitySample thin;
  for (std::size_t k = 0; k < m; ++k) {
    thin.position.push_back(sample.position[k * n / m]);
    thin.velocity.push_back(sample.velocity[k * n / m]);
  }
  return thin;
}

ScalePlace SearchScale(const std::vector<VelocitySample>& samples, int points, int threads) {
  std::vector<VelocitySample> thin;
  for (const VelocitySample& sample : samples) {
    thin.push_back(Thinned(sample, static_cast<std::size_t>(points)));
  }
  const double first = std::log(FirstScale(samples)), span = std::log(kScaleSpan);
  const double reach = Reach(samples);
  double low = first - span, high = first + span;
  Trial best = BestOf(low, high, reach, threads, thin);
  for (int k = 0; k < kExtensions && best.place.at_edge; ++k) {
    const bool up = best.place.log_scale > first;
    const double from = up ? high : low - span;
    const Trial beyond = BestOf(from, from + span, reach, threads, thin);
    (up ? high : low) += up ? span : -span;
    const bool inside = beyond.cost >= best.cost;  // the old edge is a valley after all
    if (inside) {
      best.place.at_edge = false;
    } else {
      best = beyond;
    }
  }
  ScalePlace place = best.place;
  const auto profile = [&](double log_scale) {
    return NoiseLikelihood(thin, std::exp(log_scale)).Best(place.log_r, 1, 0.3).value;
  };
  place.log_scale = Minimize(profile, place.log_scale, 0.5 * place.spacing, 0.1 * place.spacing).at;
  return place;
}

}  // namespace flocklift
