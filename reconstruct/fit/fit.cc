// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reconstruct/fit/central_differences.h"
#include "reconstruct/fit/depth_noise.h"
#include "reconstruct/fit/fit_measures.h"
#include "reconstruct/fit/fit_scene.h"
#include "reconstruct/fit/fit_setup.h"
#include "reconstruct/fit/fit_warnings.h"
#include "reconstruct/fit/fitter.h"
#include "reconstruct/fit/known_within.h"
#include "reconstruct/fit/process_model.h"
#include "reconstruct/fit/radius_choice.h"
#include "reconstruct/fit/state_space.h"
#include "reconstruct/fit/statistics_fit.h"
#include "reconstruct/fit/swarm_noise.h"
#include "reconstruct/fit/window_choice.h"
#include "simulate/core/check.h"
#include "simulate/core/model_terms.h"
#include "simulate/flock/model.h"

namespace flocklift {
namespace internal {
namespace {

// Positions times unknown depth errors: what a state-space estimate holds three slopes of.
constexpr double kMostDepthSlopes = 3e6;

bool IsOfWalls(const std::string& name) { return name == "alpha_b" || name.starts_with("walls"); }

std::vector<std::string> DefaultFree(const FitProblem& problem) {
  std::vector<std::string> names = LinearWeights(problem.model);
  if (!problem.walls) std::erase_if(names, IsOfWalls);
  return names;
}

}  // namespace

FitResult Fitter::Run(const Progress& progress) {
  model_ = CompleteModel(problem_.model);
  free_ = problem_.free.empty() ? DefaultFree(problem_) : problem_.free;
  ChooseMethod();
  const auto of_walls = std::find_if(free_.begin(), free_.end(), IsOfWalls);
  if (!problem_.walls && of_walls != free_.end()) {
    throw InputError(problem_.model.where, 0,
                     *of_walls + " is to be fitted, but there are no walls",
                     "say where the walls are, or leave " + *of_walls + " out");
  }
  around_ = SurroundingsOf(problem_);
  WidenSpeedLimits(problem_, flock_, &model_, &result_.warnings);
  UseGoal({});  // also checks the names
  result_.parameters.model = model_;
  result_.parameters.walls = problem_.walls;
  result_.animals = flock_.animals();
  const FrameSpan span = flock_.span();
  result_.frames = span.last - span.first + 1;
  if (!(SecondDifferenceMeanSquare(flock_, 1) >= 0)) {
    result_.status = flock_.animals() == 0 ? FitStatus::kTooFewAnimals : FitStatus::kTooFewFrames;
    return std::move(result_);
  }
  ChooseRows();
  ChooseWhitening();
  WhitenedFit fit = Solve(progress);
  if (fit.IsUsable()) SettleGoal(&fit);
  if (fit.IsUsable() && result_.method == FitMethod::kStateSpace) EstimateStates(&fit);
  if (!fit.IsUsable()) {
    result_.status = fit.regression.status == RegressionStatus::kTooFewTimes
                         ? FitStatus::kTooFewFrames
                         : FitStatus::kTooFewRows;
    return std::move(result_);
  }
  if (result_.method != FitMethod::kStateSpace) TestHeldWeights();
  SummarizeWeights(fit);
  SummarizeRest(fit);
  if (options_.held_out > 0) result_.r2_held_out = Prediction();
  if (trajectories_.has_sd_depth && options_.depth_draws > 0) AddDepthFactors(fit);
  WriteParametersOf(fit);
  AddWarnings(options_, Pull(), MedianSdDepth(trajectories_), &result_);
  return std::move(result_);
}

void Fitter::ChooseMethod() {
  const std::vector<std::string> smooth = SmoothParameters(model_);
  const auto is_smooth = [&](const std::string& name) {
    return std::find(smooth.begin(), smooth.end(), name) != smooth.end();
  };
  result_.method = problem_.method;
  if (result_.method == FitMethod::kAuto) {
    const bool possible = !smooth.empty() && !trajectories_.has_sd_depth &&
                          std::all_of(problem_.free.begin(), problem_.free.end(), is_smooth);
    result_.method = possible ? FitMethod::kStateSpace : FitMethod::kErrorsInVariables;
  }
  weights_ = free_.size();
  if (result_.method != FitMethod::kStateSpace) return;
  if (problem_.free.empty()) std::erase_if(free_, [&](const auto& n) { return !is_smooth(n); });
  MakeProcessModel(model_, free_, problem_.walls, around_);  // or throws
  const std::vector<std::string> linear = LinearWeights(model_);
  const auto others = std::stable_partition(free_.begin(), free_.end(), [&](const auto& name) {
    return std::find(linear.begin(), linear.end(), name) != linear.end();
  });
  weights_ = static_cast<std::size_t>(others - free_.begin());
  if (weights_ > 0) return;
  throw InputError(problem_.model.where, 0, "none of the parameters to be fitted is a weight",
                   "free one of those too: radii alone have nothing to start from");
}

void Fitter::ChooseRows() {
  window_ = options_.window > 0 ? options_.window : ChooseWindow(flock_, options_.longest_window);
  if (result_.method == FitMethod::kDifferences) window_ = 1;
  result_.window = window_;
  std::int64_t points = 0;
  for (int f = flock_.span().first; f <= flock_.span().last; ++f) points += flock_.Count(f);
  stride_ = static_cast<int>((points + options_.max_rows - 1) / options_.max_rows);
  middles_ = Middles(flock_, window_, stride_);
}

void Fitter::ChooseWhitening() {
  whitening_.lagged =
      result_.method != FitMethod::kDifferences && noise_assumed_ != NoiseAssumed::kIsSmall;
  whitening_.memory = noise_assumed_ == NoiseAssumed::kMayLast;
  whitening_.own_speed = terms_.has_own_speed;
  whitening_.stride = stride_;
  if (!trajectories_.has_sd_depth) return;
  whitening_.sight = [this](int frame, const Vec3d& position) {
    return DepthDirection(problem_.camera, frame, position);
  };
}

MotionRows Fitter::Rows(const ObservedFlock& flock, const Progress& progress) const {
  if (result_.method == FitMethod::kDifferences) {
    return CentralDifferenceRows(terms_, flock, middles_);
  }
  return BuildMotionRows({.window = window_, .substeps = options_.substeps, .threads = threads_},
                         terms_, flock, middles_, progress);
}

WhitenedFit Fitter::Solve(const Progress& progress) {
  rows_ = Rows(flock_, progress);
  whitening_.depth_variance = 0;
  WhitenedFit fit = SolveWhitened(whitening_, rows_);
  if (fit.IsUsable() && fit.depth_variance > 0) {
    whitening_.depth_variance = fit.depth_variance;
    fit = SolveWhitened(whitening_, rows_);
  }
  if (fit.IsUsable()) {
    u_ = Unexplained(rows_, fit.regression.estimate, whitening_.own_speed);
  }
  return fit;
}

void Fitter::EstimateStates(WhitenedFit* fit) {
  if (goal_) {
    result_.method = FitMethod::kErrorsInVariables;
    result_.warnings.emplace_back(
        "a point attracts the animals, which a state-space estimate does not know: by "
        "regression");
    return;
  }
  const ProcessModel process = MakeProcessModel(model_, free_, problem_.walls, around_);
  std::vector<double> start = process.start;
  std::copy(fit->regression.estimate.begin(), fit->regression.estimate.end(), start.begin());
  const StateSpaceOptions options{
      .filter = {.substeps = options_.substeps, .bridged_gap = options_.bridged_gap},
      .threads = threads_};
  const FilterInput input(flock_);
  const std::optional<DepthErrors> errors = StatedDepthErrors();
  const std::size_t unknown = errors ? UnknownDepthErrors(*errors, input) : 0;
  if (static_cast<double>(unknown * input.sightings()) > kMostDepthSlopes) {
    result_.method = FitMethod::kErrorsInVariables;
    result_.warnings.push_back(fmt::format(
        "a state-space estimate of {} positions would have {} unknown depth errors: by regression",
        input.sightings(), unknown));
    return;
  }
  std::optional<DepthPaths> known_paths;
  if (unknown > 0) known_paths.emplace(*errors, input);
  const DepthPaths* const paths = known_paths ? &*known_paths : nullptr;
  const StateSpaceFit states = FitStateSpace(options, process, start, input, paths);
  if (!states.IsUsable()) {
    fit->regression.status = RegressionStatus::kTooFewRows;
    return;
  }
  fit->converged = states.status == StateSpaceStatus::kOk;
  if (fit->converged) ScoreHeldParameters(options, states, input, paths);
  fit->rho.reset();  // the noise is white
  fit->regression.estimate = states.estimate;
  fit->regression.sd.resize(states.sd.size());
  for (std::size_t p = 0; p < states.sd.size(); ++p) {
    fit->regression.sd[p] = std::hypot(states.sd[p], RoundingOf(states.estimate[p]));
  }
  fit->regression.correlation = states.correlation;
  result_.diffusion = states.noise.diffusion;
  result_.diffusion_sd = states.diffusion_sd;
  result_.position_noise = std::sqrt(states.noise.position_variance);
  parameter_rms_ = ParameterRms(process, states.estimate, states.sd, flock_, options_.substeps);
  if (weights_ < free_.size()) {  // the rows were made with the others as given
    for (std::size_t c = weights_; c < free_.size(); ++c) {
      *FindNumber(&model_, free_[c]) = states.estimate[c];
    }
    UseGoal({});
    rows_ = Rows(flock_, {});
  }
  u_ = Unexplained(rows_, WeightsOf(states.estimate), whitening_.own_speed);
}

std::vector<double> Fitter::WeightsOf(const std::vector<double>& theta) const {
  return {theta.begin(), theta.begin() + static_cast<std::ptrdiff_t>(rows_.terms)};
}

std::optional<double> Fitter::Prediction() const {
  const double share = options_.held_out > 0 ? options_.held_out : FitOptions().held_out;
  const int held_out = static_cast<int>(share * result_.frames);
  return HeldOutR2(whitening_, rows_, flock_.span().last - held_out + 1, flock_.animals());
}

double Fitter::Pull() const { return problem_.walls ? 0 : PullToTheMiddle(rows_, u_); }

}  // namespace internal

namespace {

FitResult FitByMethod(const FitOptions& options, const FitProblem& given,
                      const Trajectories& trajectories, double fps, std::uint64_t seed, int threads,
                      const Progress& progress) {
  FitProblem problem = internal::InScene(given);
  if (problem.scene && problem.model.name == "swarm") {
    throw InputError("--scene", 0, "the noise of a swarm is sought without its surroundings",
                     "leave the scene out, and give --walls and --goal");
  }
  const bool by_statistics = internal::ByStatistics(problem);
  if (problem.model.name == "swarm") {
    return internal::FitSwarmNoise(options, problem, trajectories, fps, threads);
  }
  if (by_statistics) {
    return internal::FitStatistics(options, problem, trajectories, fps, seed, threads, progress);
  }
  if (problem.method == FitMethod::kNoiseField) {
    throw InputError(problem.model.where, 0, "model " + problem.model.name + " drifts in no noise",
                     "take the model swarm, or another --method");
  }
  const std::string why = internal::WhyNotRegressed(problem);
  if (!problem.model.terms.empty() && !why.empty()) {
    throw InputError("--method", 0,
                     "model " + problem.model.name + " cannot be fitted by regression: " + why,
                     "take --method statistics");
  }
  FitOptions chosen = internal::InScene(options, problem, fps);
  const bool regressed =
      problem.method == FitMethod::kErrorsInVariables || problem.method == FitMethod::kAuto;
  const bool by_flight = regressed && trajectories.has_sd_depth && options.window == 0;
  internal::RadiusChoice choice{.problem = problem, .notes = {}};
  if (by_flight) {
    chosen.window =
        internal::ChooseWindowByFlight(chosen, choice, trajectories, fps, seed, threads);
  }
  if (regressed) {
    choice = internal::ChooseRadii(chosen, problem, trajectories, fps, seed, threads);
  }
  if (by_flight && !choice.notes.empty()) {
    chosen.window = 0;
    chosen.window =
        internal::ChooseWindowByFlight(chosen, choice, trajectories, fps, seed, threads);
  }
  internal::Fitter fitter(chosen, choice.problem, trajectories, fps, seed, threads);
  fitter.Assume(choice.noise);
  FitResult result = fitter.Run(progress);
  result.warnings.insert(result.warnings.begin(), choice.notes.begin(), choice.notes.end());
  return result;
}

}  // namespace

FitResult FitModel(const FitOptions& options, const FitProblem& problem,
                   const Trajectories& trajectories, double fps, std::uint64_t seed, int threads,
                   const Progress& progress) {
  CheckOptions(options);
  Check(fps > 0, "fps must be positive");
  FitResult result = FitByMethod(options, problem, trajectories, fps, seed, threads, progress);
  internal::FlagLooselyKnown(options.known_within, &result);
  return result;
}

}  // namespace flocklift
