// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reconstruct/fit/kernel_breaks.h"
#include "reconstruct/fit/kernel_evidence.h"
#include "reconstruct/fit/kernel_misfit.h"
#include "reconstruct/fit/kernel_moments.h"
#include "reconstruct/fit/kernel_penalties.h"
#include "reconstruct/fit/kernel_sandwich.h"
#include "simulate/core/check.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kRounds = 3;  // of choosing breaks
constexpr int kDraws = 2;   // of position noise once more
constexpr int kStages = kRounds + kDraws;
constexpr double kFinest = 4;   // shortest part of a spline, in sd of the positions
constexpr int kPoints = 4;      // between two breaks, that are given
constexpr double kRare = 1e-3;  // share of the mean density of pairs that counts as none
constexpr double kFlat = 1e-9;  // share of the widest extent below which a coordinate stands still

constexpr const char* kAttraction = "attraction";
constexpr const char* kAlignment = "alignment";

constexpr int kRowsAnInterval = 20;  // when their number is chosen, of each kernel
constexpr int kFewest = 4, kMost = 80;

void CheckKernels(const KernelFitOptions& options) {
  Check(options.intervals == 0 || options.intervals >= kFewest,
        "a kernel's spline has 4 intervals at least, or 0 to have them chosen");
  for (const std::string& name : options.kernels) {
    Check(name == kAttraction || name == kAlignment,
          "--free: there is no kernel " + name + ": attraction or alignment");
    Check(name != kAlignment || options.order == 2,
          "an alignment needs a motion of order 2: with order 1 nobody has a velocity to align");
  }
}

std::vector<ObservedFlock> Observe(const std::vector<Trajectories>& flocks, double fps, int gap) {
  std::vector<ObservedFlock> observed;
  for (const Trajectories& flock : flocks) observed.emplace_back(flock, fps, gap);
  return observed;
}

std::array<bool, 3> Coordinates(const std::vector<Trajectories>& flocks) {
  Vec3d low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = -1.0 * low;
  for (const Trajectories& flock : flocks) {
    for (const Trajectory& trajectory : flock.trajectories) {
      for (const TrajectoryPoint& point : trajectory.points) {
        const Vec3d& x = point.position;
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
      }
    }
  }
  const Vec3d extent = high - low;
  const double flat = kFlat * std::max({extent.x, extent.y, extent.z});
  return {extent.x > flat, extent.y > flat, extent.z > flat};
}

// The positions with `sign` times one and the same noise added.
std::vector<Trajectories> Disturbed(std::vector<Trajectories> flocks,
                                    const std::array<bool, 3>& coordinates, double sd,
                                    std::uint64_t seed) {
  std::uint64_t stream = 0;
  for (Trajectories& flock : flocks) {
    for (Trajectory& trajectory : flock.trajectories) {
      Rng rng(seed, stream++);
      for (TrajectoryPoint& point : trajectory.points) {
        const Vec3d noise = {rng.Normal(), rng.Normal(), rng.Normal()};
        if (coordinates[0]) point.position.x += sd * noise.x;
        if (coordinates[1]) point.position.y += sd * noise.y;
        if (coordinates[2]) point.position.z += sd * noise.z;
      }
    }
  }
  return flocks;
}

FittedKernel KernelOf(const std::string& name, const SplineBasis& basis, Index offset,
                      const KernelEvidence& evidence) {
  FittedKernel kernel;
  kernel.name = name;
  kernel.basis = basis;
  for (Index i = 0; i < basis.size(); ++i) {
    kernel.coefficients.push_back(evidence.coefficients[offset + i]);
    for (Index j = 0; j < basis.size(); ++j) {
      kernel.covariance.push_back(evidence.covariance(offset + i, offset + j));
    }
  }
  return kernel;
}

std::vector<FittedKernel> KernelsOf(const KernelDesign& design, const KernelEvidence& evidence) {
  std::vector<FittedKernel> kernels;
  if (design.has_attraction) {
    kernels.push_back(KernelOf(kAttraction, design.attraction, 0, evidence));
  }
  if (design.has_alignment) {
    kernels.push_back(KernelOf(kAlignment, design.alignment, design.alignment_offset(), evidence));
  }
  return kernels;
}

void AddMisfits(const PairDensity& pairs, const KernelEvidence& evidence,
                std::vector<FittedKernel>* kernels) {
  std::vector<SplineBasis> bases;
  for (const FittedKernel& kernel : *kernels) bases.push_back(kernel.basis);
  std::vector<std::vector<double>> misfits = KernelMisfits(bases, pairs, evidence.h, evidence.r);
  for (std::size_t k = 0; k < misfits.size(); ++k) (*kernels)[k].misfit = std::move(misfits[k]);
}

// |phi''|, from slopes a few cells apart.
double Bend(const FittedKernel& kernel, double r) {
  const SplineBasis& basis = kernel.basis;
  const double step = 0.002 * (basis.high() - basis.low());
  const double at = std::clamp(r, basis.low() + step, basis.high() - step);
  return std::abs(kernel.Value(at - step) - 2 * kernel.Value(at) + kernel.Value(at + step)) /
         (step * step);
}

// Of the pairs, those at whose distance the 95 % band leaves 0 out.
double ShareBeyondZero(const FittedKernel& kernel) {
  double beyond = 0, all = 0;
  const std::size_t last = kernel.points.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const KernelPoint& point = kernel.points[k];
    const double width =
        kernel.points[std::min(k + 1, last)].distance - kernel.points[k > 0 ? k - 1 : 0].distance;
    const double pairs = point.density * width;
    all += pairs;
    if (std::abs(point.value) > 1.96 * point.sd) beyond += pairs;
  }
  return all > 0 ? beyond / all : 0;
}

// Where a spline on its own, all else known, would be less certain than this share of the kernel's
// height, the data say nothing by themselves: what the band knows there is that kernels are smooth.
constexpr double kLoneSd = 0.5;

void AddPoints(const PairDensity& pairs, const Eigen::VectorXd& information, FittedKernel* kernel) {
  const std::vector<double>& breaks = kernel->basis.breaks();
  const double mean_density = 1 / (pairs.high - pairs.low);
  double height = 0, sum = 0;
  std::vector<double> lone;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const double width = (breaks[k + 1] - breaks[k]) / kPoints;
    for (int part = 0; part < kPoints; ++part) {
      KernelPoint point;
      point.distance = breaks[k] + (part + 0.5) * width;
      point.value = kernel->Value(point.distance);
      point.sd = kernel->Sd(point.distance);
      point.density = pairs.At(point.distance, 0.5 * kPoints * width);
      height += width * point.density * point.value * point.value;
      sum += width * point.density;
      const SplineBasis::Local local = kernel->basis.At(point.distance);
      double sd = 0;
      for (int i = 0; i <= kernel->basis.degree(); ++i) {
        sd += local.value[static_cast<std::size_t>(i)] /
              std::sqrt(std::max(information[local.first + i], 1e-300));
      }
      lone.push_back(sd);
      kernel->points.push_back(point);
    }
  }
  height = std::sqrt(height / std::max(sum, 1e-300));
  for (std::size_t k = 0; k < kernel->points.size(); ++k) {
    KernelPoint& point = kernel->points[k];
    point.known = point.density > kRare * mean_density && 1.96 * point.sd < height &&
                  lone[k] < kLoneSd * height;
  }
}

// A kernel that was not asked for: is it there all the same? By a fit of both.
constexpr double kContradicted = 0.5;  // share of the pairs whose band leaves 0 out

void WarnOfLeftOut(const KernelFitOptions& options, const std::vector<Trajectories>& flocks,
                   double fps, std::uint64_t seed, int threads, KernelFit* fit) {
  if (options.order != 2 || fit->kernels.size() != 1) return;
  KernelFitOptions both = options;
  both.kernels = {};
  const KernelFit whole = FitKernels(both, flocks, fps, seed, threads);
  if (!whole.IsUsable()) return;
  for (const FittedKernel& kernel : whole.kernels) {
    if (kernel.name == fit->kernels[0].name) continue;
    fit->left_out = {.name = kernel.name, .share = ShareBeyondZero(kernel)};
    if (fit->left_out.share < kContradicted) continue;
    fit->warnings.push_back(fmt::format(
        "{} is left out, and a fit of both finds it for {:.0f} % of the pairs, so that what is "
        "fitted may be wrong: free it too (--free attraction,alignment)",
        kernel.name, 100 * fit->left_out.share));
  }
}

}  // namespace

std::string StatusText(KernelFitStatus status) {
  switch (status) {
    case KernelFitStatus::kOk:
      return "fitted";
    case KernelFitStatus::kTooFewAnimals:
      return "no two animals are there at once, or their distances never change";
    case KernelFitStatus::kTooFewFrames:
      return "too few frames: no animal has a run of frames that is long enough";
    case KernelFitStatus::kTooFewRows:
      return "too few animals and frames for so many pieces of spline: take fewer";
  }
  return "";
}

bool KernelFitOptions::Has(const std::string& kernel) const {
  if (kernels.empty()) return kernel == kAttraction || order == 2;
  return std::find(kernels.begin(), kernels.end(), kernel) != kernels.end();
}

std::string FittedKernel::Unit(int order) const {
  return order == 1 || name == kAlignment ? "1/s" : "1/s^2";
}

double FittedKernel::Sd(double distance) const {
  const SplineBasis::Local local = basis.At(distance);
  const auto n = static_cast<std::size_t>(basis.size());
  double variance = 0;
  for (int i = 0; i <= basis.degree(); ++i) {
    for (int j = 0; j <= basis.degree(); ++j) {
      variance += local.value[static_cast<std::size_t>(i)] *
                  local.value[static_cast<std::size_t>(j)] *
                  covariance[static_cast<std::size_t>(local.first + i) * n +
                             static_cast<std::size_t>(local.first + j)];
    }
  }
  const double of_noise = std::sqrt(std::max(variance, 0.0));
  if (misfit.empty()) return of_noise;
  const std::vector<double>& breaks = basis.breaks();
  const auto after = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, distance);
  return std::hypot(of_noise, misfit[static_cast<std::size_t>(after - breaks.begin()) - 1]);
}

KernelFit FitKernels(const KernelFitOptions& options, const std::vector<Trajectories>& flocks,
                     double fps, std::uint64_t seed, int threads, const Progress& progress) {
  CheckOptions(options);
  CheckKernels(options);
  Check(fps > 0, "fps must be positive");
  KernelFit fit;
  fit.flocks = static_cast<std::int64_t>(flocks.size());
  for (const Trajectories& flock : flocks) {
    fit.animals += static_cast<std::int64_t>(flock.trajectories.size());
  }
  const std::vector<ObservedFlock> observed = Observe(flocks, fps, options.bridged_gap);
  const PairDensity pairs = MeasurePairs(observed, options.reach);
  if (!pairs.IsUsable()) {
    fit.status = KernelFitStatus::kTooFewAnimals;
    return fit;
  }
  KernelDesign design;
  design.order = options.order;
  design.has_attraction = options.Has(kAttraction);
  design.has_alignment = options.Has(kAlignment);
  design.coordinates = Coordinates(flocks);
  design.reach = options.reach;
  design.segment = options.segment;
  fit.dimensions =
      static_cast<int>(std::count(design.coordinates.begin(), design.coordinates.end(), true));

  fit.rows = CountKernelRows(design, observed);
  fit.intervals = options.intervals;
  if (fit.intervals == 0) {
    const int kernels = (design.has_attraction ? 1 : 0) + (design.has_alignment ? 1 : 0);
    fit.intervals = static_cast<int>(
        std::clamp<std::int64_t>(fit.rows / (kRowsAnInterval * kernels), kFewest, kMost));
  }
  std::optional<double> known_variance;
  if (options.position_noise > 0) known_variance = options.position_noise * options.position_noise;
  KernelMoments moments;
  KernelEvidence evidence;
  evidence.position_variance = known_variance.value_or(0);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<FittedKernel> before;
    if (round > 0) before = KernelsOf(design, evidence);
    const auto basis = [&](std::size_t k) {
      const auto bend = [&, k](double r) { return Bend(before[k], r); };
      return SplineBasis(
          ChooseBreaks(pairs, fit.intervals, kFinest * std::sqrt(evidence.position_variance),
                       round > 0 ? std::function<double(double)>(bend) : nullptr),
          options.degree);
    };
    if (design.has_attraction) design.attraction = basis(0);
    if (design.has_alignment) design.alignment = basis(design.has_attraction ? 1 : 0);
    moments = GatherKernelMoments(design, observed, observed, threads);
    fit.rows = static_cast<std::int64_t>(moments.rows());
    if (moments.runs == 0) {
      fit.status = KernelFitStatus::kTooFewFrames;
      return fit;
    }
    if (fit.rows < 2 * design.terms()) {
      fit.status = KernelFitStatus::kTooFewRows;
      return fit;
    }
    evidence = SolveKernels(moments, moments, SmoothnessOf(design), known_variance);
    Report(progress, round + 1, kStages);
  }
  if (design.has_alignment && evidence.position_variance > 0) {
    KernelMoments corrected = moments;
    const double sd = std::sqrt(evidence.position_variance);
    for (int draw = 0; draw < kDraws; ++draw) {
      for (const double sign : {1.0, -1.0}) {
        const std::vector<ObservedFlock> moved =
            Observe(Disturbed(flocks, design.coordinates, sign * sd,
                              seed + static_cast<std::uint64_t>(draw)),
                    fps, options.bridged_gap);
        const KernelMoments disturbed = GatherKernelMoments(design, observed, moved, threads);
        for (auto& [place, bin] : corrected.bins) {
          bin.moment +=
              (moments.bins.at(place).moment - disturbed.bins.at(place).moment) / (2 * kDraws);
        }
      }
      Report(progress, kRounds + 1 + draw, kStages);
    }
    evidence = SolveKernels(moments, corrected, SmoothnessOf(design), known_variance);
  } else {
    evidence.covariance = KernelSandwich(design, observed, moments.modes, evidence, threads);
  }
  fit.kernels = KernelsOf(design, evidence);
  AddMisfits(pairs, evidence, &fit.kernels);
  Index offset = 0;
  for (FittedKernel& kernel : fit.kernels) {
    AddPoints(pairs, evidence.information.segment(offset, kernel.basis.size()), &kernel);
    offset += kernel.basis.size();
  }
  fit.position_noise = std::sqrt(evidence.position_variance);
  fit.diffusion = evidence.diffusion;
  fit.explained = evidence.explained;
  fit.effective = evidence.effective;
  fit.converged = evidence.converged;
  if (!fit.converged) fit.warnings.emplace_back("the search for noise and smoothness did not end");
  WarnOfLeftOut(options, flocks, fps, seed, threads, &fit);
  const bool depths = std::any_of(flocks.begin(), flocks.end(),
                                  [](const Trajectories& flock) { return flock.has_sd_depth; });
  if (depths) {
    fit.warnings.emplace_back(
        "the positions state depth errors, which last and are larger along the line of sight: the "
        "bands count on errors that are new in every frame and equal in all directions");
  }
  return fit;
}

}  // namespace flocklift
