// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/kernel_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr std::uint64_t kNewStarts = 1000003;  // added to the seed

const DistanceKernel& TrueKernel(const KernelSystem& system, const std::string& name) {
  return name == "alignment" ? system.alignment : system.attraction;
}

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Errors of the two parts of time, relative.
std::pair<double, double> Compare(const KernelSystem& system, const std::vector<KernelState>& truth,
                                  const std::vector<KernelState>& flown) {
  const auto n = static_cast<double>(system.animals);
  Vec3d mean;
  for (const Vec3d& x : truth[0].x) mean += x / n;
  double extent = 0;
  for (const Vec3d& x : truth[0].x) extent += SquaredNorm(x - mean) / n;
  std::pair<double, double> errors;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    double square = 0;
    for (std::size_t i = 0; i < truth[k].x.size(); ++i) {
      square += SquaredNorm(truth[k].x[i] - flown[k].x[i]) / n;
    }
    double& error = static_cast<int>(k) < system.frames ? errors.first : errors.second;
    error = std::max(error, std::sqrt(square / extent));
  }
  return errors;
}

}  // namespace

std::vector<KernelScore> ScoreKernels(const KernelSystem& system, const KernelFit& fit) {
  std::vector<KernelScore> scores;
  for (const FittedKernel& kernel : fit.kernels) {
    const DistanceKernel& truth = TrueKernel(system, kernel.name);
    double error = 0, size = 0, covered = 0, known = 0, all = 0, variance = 0, square = 0;
    for (std::size_t k = 0; k < kernel.points.size(); ++k) {
      const KernelPoint& point = kernel.points[k];
      // Half the way to the points beside.
      const double low = kernel.points[k == 0 ? 0 : k - 1].distance;
      const double high = kernel.points[std::min(k + 1, kernel.points.size() - 1)].distance;
      const double rho = 0.5 * (high - low) * point.density;
      const double is = truth(point.distance), r2 = point.distance * point.distance;
      error += rho * r2 * (point.value - is) * (point.value - is);
      size += rho * r2 * is * is;
      all += rho;
      if (!point.known) continue;
      known += rho;
      variance += rho * point.sd * point.sd;
      square += rho * (point.value - is) * (point.value - is);
      if (std::abs(point.value - is) <= 1.96 * point.sd) covered += rho;
    }
    scores.push_back({.kernel = kernel.name,
                      .error = std::sqrt(error / size),
                      .coverage = covered / std::max(known, 1e-300),
                      .width = std::sqrt(variance / std::max(square, 1e-300)),
                      .known = known / all});
  }
  return scores;
}

PredictionScore ScorePrediction(const KernelSystem& system, const KernelFit& fit,
                                std::uint64_t seed, int runs) {
  Check(fit.IsUsable(), "there is no fit to predict with");
  KernelSystem exact = system;
  exact.diffusion = 0;
  KernelSystem fitted = exact;
  fitted.attraction = [&](double r) { return fit.kernels[0].Value(r); };
  if (system.alignment) fitted.alignment = [&](double r) { return fit.kernels[1].Value(r); };
  const int frames = static_cast<int>(std::lround(system.last_end / system.dt())) + 1;
  PredictionScore score;
  for (int run = 0; run < runs; ++run) {
    for (const bool is_new : {false, true}) {
      const KernelState start = StartOf(system, seed + (is_new ? kNewStarts : 0), run);
      const auto [seen, later] = Compare(system, Fly(exact, start, frames, seed, run),
                                         Fly(fitted, start, frames, seed, run));
      (is_new ? score.new_seen_time : score.seen_time) += seen / runs;
      (is_new ? score.new_later_time : score.later_time) += later / runs;
    }
  }
  return score;
}

KernelTrial TryKernels(const KernelSystem& system, const KernelFitOptions& options, double noise,
                       std::uint64_t seed, int predicted_runs, int threads) {
  std::vector<Trajectories> seen;
  for (int run = 0; run < system.runs; ++run) {
    const KernelState start = StartOf(system, seed, run);
    seen.push_back(Seen(system, Fly(system, start, system.frames, seed, run), noise, seed, run));
  }
  KernelFitOptions of_system = options;
  of_system.order = system.order;
  KernelTrial trial;
  const double before = CpuSeconds();
  trial.fit = FitKernels(of_system, seen, system.fps(), seed, threads);
  trial.row = {.system = system.name,
               .noise = noise,
               .kernels = ScoreKernels(system, trial.fit),
               .prediction = {},
               .position_noise = trial.fit.position_noise,
               .seconds = CpuSeconds() - before};
  if (predicted_runs > 0) {
    trial.row.prediction = ScorePrediction(system, trial.fit, seed, predicted_runs);
  }
  return trial;
}

std::string KernelTable(const std::vector<KernelRow>& rows) {
  std::string text =
      "| system | position noise | kernel | relative L2(rho) error, % | bands cover, % of rho | "
      "band over error | known, % of rho | prediction error, seen starts: seen / later time, % | "
      "new starts, % | "
      "CPU s |\n| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  std::map<std::pair<std::string, double>, std::vector<KernelRow>> groups;
  std::vector<std::pair<std::string, double>> order;
  for (const KernelRow& row : rows) {
    const std::pair key(row.system, row.noise);
    if (!groups.contains(key)) order.push_back(key);
    groups[key].push_back(row);
  }
  for (const auto& key : order) {
    const std::vector<KernelRow>& group = groups[key];
    const auto mean = [&](const auto& figure) {
      double sum = 0;
      for (const KernelRow& row : group) sum += figure(row) / static_cast<double>(group.size());
      return sum;
    };
    for (std::size_t k = 0; k < group[0].kernels.size(); ++k) {
      text += fmt::format(
          "| {} | {:g} | {} | {:.2f} | {:.0f} | {:.1f} | {:.0f} | {:.3g} / {:.3g} | {:.3g} / "
          "{:.3g} | "
          "{:.1f} |\n",
          key.first, key.second, group[0].kernels[k].kernel,
          100 * mean([&](const KernelRow& r) { return r.kernels[k].error; }),
          100 * mean([&](const KernelRow& r) { return r.kernels[k].coverage; }),
          mean([&](const KernelRow& r) { return r.kernels[k].width; }),
          100 * mean([&](const KernelRow& r) { return r.kernels[k].known; }),
          100 * mean([](const KernelRow& r) { return r.prediction.seen_time; }),
          100 * mean([](const KernelRow& r) { return r.prediction.later_time; }),
          100 * mean([](const KernelRow& r) { return r.prediction.new_seen_time; }),
          100 * mean([](const KernelRow& r) { return r.prediction.new_later_time; }),
          mean([](const KernelRow& r) { return r.seconds; }));
    }
  }
  return text;
}

}  // namespace flocklift
