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
#include "reconstruct/fit/fit_setup.h"
#include "reconstruct/fit/fit_warnings.h"
#include "reconstruct/fit/flock_terms.h"
#include "reconstruct/fit/motion_rows.h"
#include "reconstruct/fit/state_space.h"
#include "reconstruct/fit/whitened_fit.h"
#include "simulate/core/check.h"
#include "simulate/flock/model.h"

namespace flocklift {
namespace {

constexpr double kConfining = 0.05;       // share of u pulling to the middle that calls for a goal
constexpr int kGoalRounds = 8;            // of moving it
constexpr double kGoalTolerance = 0.03;   // ... until it moves by less, of its range
constexpr std::size_t kFrameEffects = 5;  // animals a frame that frame effects need
// A weight is determined when its 95 % interval leaves 0 out, or when all of the interval would
// change accelerations by less than this share of what the model explains.
constexpr double kSmallShare = 0.25;
// A radius or another parameter that is no weight, when its interval is within this share of it.
constexpr double kRadiusShare = 0.25;
// ... and when one more depth error of the stated size changes it, and its term, by less than this.
constexpr double kDepthShare = 0.5;

std::vector<std::string> DefaultFree(const FitProblem& problem) {
  std::vector<std::string> names = LinearWeights(problem.model.name);
  if (!problem.walls) std::erase(names, "alpha_b");
  return names;
}

class Fitter {
 public:
  Fitter(const FitOptions& options, const FitProblem& problem, const Trajectories& trajectories,
         double fps, std::uint64_t seed, int threads)
      : options_(options),
        problem_(problem),
        trajectories_(trajectories),
        fps_(fps),
        seed_(seed),
        threads_(threads),
        flock_(trajectories, fps, options.bridged_gap) {}

  FitResult Run(const Progress& progress) {
    model_ = CompleteModel(problem_.model);
    free_ = problem_.free.empty() ? DefaultFree(problem_) : problem_.free;
    ChooseMethod();
    if (!problem_.walls && std::find(free_.begin(), free_.end(), "alpha_b") != free_.end()) {
      throw InputError(problem_.model.where, 0, "alpha_b is to be fitted, but there are no walls",
                       "say where the walls are, or leave alpha_b out");
    }
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
    SummarizeWeights(fit);
    SummarizeRest(fit);
    if (options_.held_out > 0) result_.r2_held_out = Prediction();
    if (trajectories_.has_sd_depth && options_.depth_draws > 0) AddDepthFactors(fit);
    WriteParametersOf(fit);
    AddWarnings(options_, Pull(), MedianSdDepth(trajectories_), &result_);
    return std::move(result_);
  }

 private:
  void UseGoal(const std::optional<GoalSpec>& goal) {
    goal_ = goal;
    std::vector<std::string> names(free_.begin(),
                                   free_.begin() + static_cast<std::ptrdiff_t>(weights_));
    if (goal) names.push_back(kGoalWeight);
    // A goal that moves pushes all animals alike by its motion; what their cruising speeds have in
    // common is then taken from their speeds.
    whitening_.frame_effects =
        goal.has_value() &&
        rows_.size() >= kFrameEffects * static_cast<std::size_t>(result_.frames);
    cruising_speed_ = whitening_.frame_effects ? MeanSpeed(flock_) : 0;
    terms_ = MakeFlockTerms(model_, names, problem_.walls, goal, cruising_speed_);
  }

  // Also puts the parameters that are not weights, which only a state-space estimate can free,
  // last.
  void ChooseMethod() {
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
    MakeProcessModel(model_, free_, problem_.walls);  // or throws
    const std::vector<std::string> linear = LinearWeights(model_.name);
    const auto others = std::stable_partition(free_.begin(), free_.end(), [&](const auto& name) {
      return std::find(linear.begin(), linear.end(), name) != linear.end();
    });
    weights_ = static_cast<std::size_t>(others - free_.begin());
    if (weights_ > 0) return;
    throw InputError(problem_.model.where, 0, "none of the parameters to be fitted is a weight",
                     "free one of those too: radii alone have nothing to start from");
  }

  // From the regression's estimate, which it replaces, and the other parameters as given.
  void EstimateStates(WhitenedFit* fit) {
    if (goal_) {
      result_.method = FitMethod::kErrorsInVariables;
      result_.warnings.emplace_back(
          "a point attracts the animals, which a state-space estimate does not know: by "
          "regression");
      return;
    }
    const ProcessModel process = MakeProcessModel(model_, free_, problem_.walls);
    std::vector<double> start = process.start;
    std::copy(fit->regression.estimate.begin(), fit->regression.estimate.end(), start.begin());
    const StateSpaceOptions options{
        .filter = {.substeps = options_.substeps, .bridged_gap = options_.bridged_gap},
        .threads = threads_};
    const StateSpaceFit states = FitStateSpace(options, process, start, FilterInput(flock_));
    if (!states.IsUsable()) {
      fit->regression.status = RegressionStatus::kTooFewRows;
      return;
    }
    fit->converged = states.status == StateSpaceStatus::kOk;
    fit->rho.reset();  // the noise is white
    fit->regression.estimate = states.estimate;
    fit->regression.sd = states.sd;
    fit->regression.correlation = states.correlation;
    result_.diffusion = states.noise.diffusion;
    result_.diffusion_sd = states.diffusion_sd;
    result_.position_noise = std::sqrt(states.noise.position_variance);
    parameter_rms_ = ParameterRms(process, states.estimate, states.sd, flock_, options_.substeps);
    if (weights_ < free_.size()) {  // the rows were made with the others as given
      for (std::size_t c = weights_; c < free_.size(); ++c) {
        model_.parameters[free_[c]] = states.estimate[c];
      }
      UseGoal({});
      rows_ = Rows(flock_, {});
    }
    u_ = Unexplained(rows_, WeightsOf(states.estimate), whitening_.own_speed);
  }

  // Without the parameters that are none.
  std::vector<double> WeightsOf(const std::vector<double>& theta) const {
    return {theta.begin(), theta.begin() + static_cast<std::ptrdiff_t>(rows_.terms)};
  }

  void ChooseWhitening() {
    whitening_.lagged = result_.method != FitMethod::kDifferences;
    whitening_.own_speed = terms_.has_own_speed;
    whitening_.stride = stride_;
    if (!trajectories_.has_sd_depth) return;
    whitening_.sight = [this](int frame, const Vec3d& position) {
      return DepthDirection(problem_.camera, frame, position);
    };
  }

  // Rows and weights for the terms as they are; u_ is what they leave over.
  WhitenedFit Solve(const Progress& progress) {
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

  double Pull() const { return problem_.walls ? 0 : PullToTheMiddle(rows_, u_); }

  std::optional<double> Prediction() const {
    const double share = options_.held_out > 0 ? options_.held_out : FitOptions().held_out;
    const int held_out = static_cast<int>(share * result_.frames);
    return HeldOutR2(whitening_, rows_, flock_.span().last - held_out + 1, flock_.animals());
  }

  // Fits with a goal where one is called for, and keeps it when it predicts better.
  void SettleGoal(WhitenedFit* fit) {
    const bool possible = model_.parameters.contains("goal_range");
    if (!possible || problem_.goal == GoalChoice::kNone) return;
    const bool may_go_without = problem_.goal == GoalChoice::kWhenHeld;
    if (may_go_without && Pull() <= kConfining) return;
    const std::optional<double> without = Prediction();
    Vec3d mean;
    for (const Vec3d& x : rows_.position) mean += x / static_cast<double>(rows_.size());
    GoalSpec goal;
    goal.position = problem_.goal == GoalChoice::kGiven ? problem_.goal_position : mean;
    LocateGoal(goal, fit);
    if (!may_go_without || (fit->IsUsable() && Prediction() > without)) return;
    UseGoal({});
    *fit = Solve({});
  }

  // The goal moves to where the mean of what is left over vanishes, unless its place was given.
  void LocateGoal(GoalSpec goal, WhitenedFit* fit) {
    const double range = model_.parameters.at("goal_range");
    for (int round = 0; round < kGoalRounds; ++round) {
      UseGoal(goal);
      *fit = Solve({});
      if (!fit->IsUsable() || problem_.goal == GoalChoice::kGiven) return;
      const double weight = fit->regression.estimate.back();
      if (!(weight > 0)) return;
      Vec3d left;
      double slope = 0;
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        left += u_[k];
        const double far = SquaredNorm(rows_.position[k] - goal.position) / (range * range);
        slope += weight / std::sqrt(1 + far);
      }
      const Vec3d step = left / slope;
      if (Norm(step) < kGoalTolerance * range) return;
      goal.position += std::min(1.0, range / Norm(step)) * step;
    }
  }

  void ChooseRows() {
    window_ = options_.window > 0 ? options_.window : ChooseWindow(flock_, options_.longest_window);
    if (result_.method == FitMethod::kDifferences) window_ = 1;
    result_.window = window_;
    std::int64_t points = 0;
    for (int f = flock_.span().first; f <= flock_.span().last; ++f) points += flock_.Count(f);
    stride_ = static_cast<int>((points + options_.max_rows - 1) / options_.max_rows);
    middles_ = Middles(flock_, window_, stride_);
  }

  MotionRows Rows(const ObservedFlock& flock, const Progress& progress) const {
    if (result_.method == FitMethod::kDifferences) {
      return CentralDifferenceRows(terms_, flock, middles_);
    }
    return BuildMotionRows({.window = window_, .substeps = options_.substeps, .threads = threads_},
                           terms_, flock, middles_, progress);
  }

  void SummarizeWeights(const WhitenedFit& fit) {
    const MotionRows& rows = rows_;
    const std::vector<double>& theta = fit.regression.estimate;
    const std::size_t p = theta.size();
    std::vector<double> rms = parameter_rms_;
    rms.resize(p);
    for (std::size_t c = 0; c < rows.terms; ++c) {
      std::vector<Vec3d> term;
      for (std::size_t k = 0; k < rows.size(); ++k) {
        term.push_back(rows.features[k * (rows.terms + 1) + c]);
      }
      rms[c] = std::sqrt(MeanSquare(term));
    }
    std::vector<Vec3d> explained;
    for (std::size_t k = 0; k < rows.size(); ++k) explained.push_back(rows.response[k] - u_[k]);
    result_.acceleration_sd = std::sqrt(MeanSquare(rows.response));
    const double small =
        kSmallShare * std::min(std::sqrt(MeanSquare(explained)), result_.acceleration_sd);

    WhiteningOptions least_squares = whitening_;
    least_squares.lagged = false;
    const WhitenedFit plain =
        SolveWhitened(least_squares, CentralDifferenceRows(terms_, flock_, middles_));
    std::vector<bool> positive;
    std::vector<std::string> names = terms_.free;
    names.insert(names.end(), free_.begin() + static_cast<std::ptrdiff_t>(weights_), free_.end());
    for (const std::string& name : names) positive.push_back(IsPositive(name));
    const std::vector<double> values =
        ProbableWeights(fit.regression, rms, result_.acceleration_sd, positive);
    u_ = Unexplained(rows, values, whitening_.own_speed);
    for (std::size_t c = 0; c < p; ++c) {
      FittedWeight weight;
      weight.name = names[c];
      weight.estimate = theta[c];
      weight.sd = fit.regression.sd[c];
      const bool linear = c < rows.terms;
      weight.plain = linear && plain.IsUsable() ? plain.regression.estimate[c] : std::nan("");
      const double half_width = 1.96 * weight.sd;
      const double known = (linear ? 1 : kRadiusShare) * std::abs(weight.estimate);
      weight.determined = std::isfinite(weight.sd) && fit.converged &&
                          (half_width < known || (linear && half_width * rms[c] < small));
      weight.value = values[c];
      // A term that never acted keeps the value it started with.
      if (rms[c] == 0 && model_.parameters.contains(weight.name)) {
        weight.value = weight.estimate = model_.parameters.at(weight.name);
      }
      result_.weights.push_back(weight);
    }
    result_.best = BestDirection(fit.regression, rms);
    result_.worst = WorstDirection(fit.regression, rms);
  }

  // May the model's weight be no less than 0?
  bool IsPositive(const std::string& name) const {
    const ModelInfo* const info = FindModel(model_.name);
    const auto found = std::find_if(info->parameters.begin(), info->parameters.end(),
                                    [&](const ParameterInfo& i) { return i.name == name; });
    return found == info->parameters.end() || found->range.low == 0;
  }

  void SummarizeRest(const WhitenedFit& fit) {
    const MotionRows& rows = rows_;
    result_.converged = fit.converged;
    result_.rows = static_cast<std::int64_t>(rows.size());
    result_.rows_mixed = rows.mixed;
    result_.rows_clamped = std::count(rows.clamped.begin(), rows.clamped.end(), true);
    result_.condition = fit.regression.condition;
    result_.residual_sd = std::sqrt(MeanSquare(u_));
    result_.r2 = 1 - MeanSquare(u_) / std::max(MeanSquare(rows.response), 1e-300);
    std::vector<Vec3d> own = u_;
    if (whitening_.frame_effects) RemoveFrameMeans(rows, &own);
    const double step = flock_.dt() / std::max(1, options_.substeps);
    const NoiseEstimate noise = EstimateNoise(rows, own, fit.rho, flock_.dt(), step);
    result_.noise_sd = noise.sd;
    result_.noise_time = noise.time;
    if (result_.diffusion_sd) {
      result_.noise_sd = std::sqrt(2 * result_.diffusion / step);
      result_.noise_time = 0;
      return;  // smooth models know no speeds of the animals' own
    }
    result_.diffusion = noise.diffusion;

    const auto& parameters = result_.parameters.model.parameters;
    std::vector<double> values;
    double cruise = whitening_.own_speed ? parameters.at("cruise") : 0;
    for (const FittedWeight& weight : result_.weights) {
      values.push_back(weight.value);
      if (weight.name == "cruise") cruise = weight.value;
    }
    if (!(cruise > 0)) return;
    double sum = 0, squares = 0, count = 0;
    for (const double factor : OwnFactors(rows, values, flock_.animals())) {
      if (std::isnan(factor)) continue;
      const double speed = cruising_speed_ + factor / (cruise / parameters.at("time_unit"));
      sum += speed;
      squares += speed * speed;
      count += 1;
    }
    if (count == 0) return;
    result_.own_speed_mean = sum / count;
    result_.own_speed_sd = std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
  }

  // Simulation extrapolation: what one more error of the stated size does.
  void AddDepthFactors(const WhitenedFit& fit) {
    const std::size_t p = terms_.free.size();
    std::vector<double> sums(p), squares(p), shares(p);
    int draws = 0;
    for (int draw = 0; draw < options_.depth_draws; ++draw) {
      const DepthNoiseOptions noise{.time = options_.depth_error_time,
                                    .scale_sd = options_.scale_sd,
                                    .seed = seed_,
                                    .draw = static_cast<std::uint32_t>(draw)};
      const Trajectories noisy = AddDepthNoise(noise, problem_.camera, fps_, trajectories_);
      const MotionRows noisy_rows = Rows(ObservedFlock(noisy, fps_, options_.bridged_gap), {});
      const WhitenedFit again = SolveWhitened(whitening_, noisy_rows);
      if (!again.IsUsable()) continue;
      ++draws;
      const std::vector<double> changed = ChangedShares(rows_, noisy_rows);
      for (std::size_t c = 0; c < p; ++c) {
        shares[c] += changed[c];
        const double factor = again.regression.estimate[c] / fit.regression.estimate[c];
        sums[c] += factor;
        squares[c] += factor * factor;
      }
    }
    if (draws < 2) return;
    for (std::size_t c = 0; c < p; ++c) {
      FittedWeight& weight = result_.weights[c];
      const double mean = sums[c] / draws;
      weight.depth_share = shares[c] / draws;
      if (!weight.determined || !std::isfinite(mean)) continue;
      weight.depth_factor = mean;
      weight.depth_factor_sd =
          std::sqrt(std::max(0.0, squares[c] / draws - mean * mean) / (draws - 1));
      weight.determined = std::abs(mean - 1) < kDepthShare && *weight.depth_share < kDepthShare;
    }
  }

  void WriteParametersOf(const WhitenedFit& fit) {
    auto& parameters = result_.parameters.model.parameters;
    ParameterPosterior& posterior = result_.parameters.posterior;
    const std::size_t p = result_.weights.size(), of_model = free_.size();
    for (std::size_t c = 0; c < of_model; ++c) {
      const FittedWeight& weight = result_.weights[c];
      posterior.free.push_back(weight.name);
      posterior.sd.push_back(weight.sd);
      posterior.determined.push_back(weight.determined);
      for (std::size_t d = 0; d < of_model; ++d) {
        posterior.correlation.push_back(fit.regression.correlation[c * p + d]);
      }
      parameters[weight.name] = weight.value;
    }
    if (goal_ && result_.weights.back().value > 0) {
      result_.parameters.goals = {*goal_};
      result_.parameters.goals[0].weight = result_.weights.back().value;
    }
    if (parameters.contains("noise") && parameters.contains("time_unit")) {
      const double unit = parameters.at("time_unit");
      parameters["noise"] = result_.noise_sd * unit * unit;
      parameters["noise_time"] = result_.noise_time / unit;
    }
    if (parameters.contains("diffusion")) parameters["diffusion"] = result_.diffusion;
  }

  const FitOptions& options_;
  const FitProblem& problem_;
  const Trajectories& trajectories_;
  double fps_;
  std::uint64_t seed_;
  int threads_;
  ObservedFlock flock_;
  ModelSpec model_;                    // complete
  std::vector<std::string> free_;      // of the model
  std::size_t weights_ = 0;            // of them; then those by which accelerations are not linear
  std::vector<double> parameter_rms_;  // of a state-space estimate
  std::optional<GoalSpec> goal_;
  double cruising_speed_ = 0;  // that the terms count on [m/s]
  FlockTerms terms_;
  WhiteningOptions whitening_;
  MotionRows rows_;
  int window_ = 1, stride_ = 1;
  std::vector<int> middles_;
  std::vector<Vec3d> u_;
  FitResult result_;
};

}  // namespace

FitResult FitModel(const FitOptions& options, const FitProblem& problem,
                   const Trajectories& trajectories, double fps, std::uint64_t seed, int threads,
                   const Progress& progress) {
  CheckOptions(options);
  Check(fps > 0, "fps must be positive");
  return Fitter(options, problem, trajectories, fps, seed, threads).Run(progress);
}

}  // namespace flocklift
