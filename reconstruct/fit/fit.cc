// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "reconstruct/fit/depth_noise.h"
#include "reconstruct/fit/flock_terms.h"
#include "reconstruct/fit/motion_rows.h"
#include "reconstruct/fit/whitened_fit.h"
#include "simulate/core/check.h"
#include "simulate/core/suggest.h"
#include "simulate/flock/model.h"

namespace flocklift {
namespace {

constexpr double kSpeedSlack = 0.05;     // beyond the 1st and 99th percentile of speeds
constexpr double kTooManyClamped = 0.3;  // share of rows at a speed limit worth a warning
constexpr double kConfining = 0.05;      // share of u explained by a pull to the middle, likewise

std::vector<std::string> DefaultFree(const FitProblem& problem) {
  std::vector<std::string> names = LinearWeights(problem.model.name);
  if (!problem.walls) std::erase(names, "alpha_b");
  return names;
}

double SpeedAt(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

// Speed limits that the caller did not give must let the observed flock fly.
void WidenSpeedLimits(const FitProblem& problem, const ObservedFlock& flock, ModelSpec* model,
                      std::vector<std::string>* warnings) {
  if (!model->parameters.contains("s_max") || !model->parameters.contains("time_unit")) return;
  std::vector<double> speeds;
  const FrameSpan span = flock.span();
  const int stride = std::max(1, (span.last - span.first) / 200);
  for (int f = span.first; f <= span.last; f += stride) {
    for (const Vec3d& v : flock.Between(f, 0, 1, 0).velocity) speeds.push_back(Norm(v));
  }
  if (speeds.empty()) return;
  std::sort(speeds.begin(), speeds.end());
  const double unit = model->parameters.at("time_unit");
  const double low = unit * SpeedAt(speeds, 0.01) * (1 - kSpeedSlack);
  const double high = unit * SpeedAt(speeds, 0.99) * (1 + kSpeedSlack);
  const auto widen = [&](const char* name, double wanted, bool needed) {
    if (problem.model.parameters.contains(name) || !needed) return;
    warnings->push_back(fmt::format(
        "{} is {:.3g} instead of the model's {:.3g}: the animals fly at {:.3g} to "
        "{:.3g} m/s",
        name, wanted, model->parameters.at(name), SpeedAt(speeds, 0.01), SpeedAt(speeds, 0.99)));
    model->parameters[name] = wanted;
  };
  widen("s_min", low, low < (1 - 2 * kSpeedSlack) * model->parameters.at("s_min"));
  widen("s_max", high, high > (1 + 2 * kSpeedSlack) * model->parameters.at("s_max"));
}

// The frames to make rows of: all, or every stride-th with those before it that it needs.
std::vector<int> Middles(const ObservedFlock& flock, int window, int stride) {
  const FrameSpan span = flock.span();
  std::vector<int> middles;
  for (int f = span.first; f <= span.last; ++f) {
    if (f % stride != 0) continue;
    for (const int before : FramesBefore(window, true)) middles.push_back(f - before);
    middles.push_back(f);
  }
  std::sort(middles.begin(), middles.end());
  middles.erase(std::unique(middles.begin(), middles.end()), middles.end());
  std::erase_if(middles, [&](int f) { return f < span.first || f > span.last; });
  return middles;
}

template <typename Keep>
MotionRows Filtered(const MotionRows& rows, const Keep& keep) {
  MotionRows some;
  some.terms = rows.terms;
  some.window = rows.window;
  const auto width = static_cast<std::ptrdiff_t>(rows.terms) + 1;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!keep(rows.frame[k])) continue;
    const auto begin = static_cast<std::ptrdiff_t>(k) * width;
    some.frame.push_back(rows.frame[k]);
    some.animal.push_back(rows.animal[k]);
    some.position.push_back(rows.position[k]);
    some.response.push_back(rows.response[k]);
    some.known.push_back(rows.known[k]);
    some.near_known.push_back(rows.near_known[k]);
    some.features.insert(some.features.end(), rows.features.begin() + begin,
                         rows.features.begin() + begin + width);
    some.near.insert(some.near.end(), rows.near.begin() + begin, rows.near.begin() + begin + width);
    some.far.insert(some.far.end(), rows.far.begin() + begin, rows.far.begin() + begin + width);
    some.depth_sd.push_back(rows.depth_sd[k]);
    some.clamped.push_back(rows.clamped[k]);
  }
  return some;
}

// The rows without the terms marked, whose weights are 0 then.
MotionRows WithoutTerms(const MotionRows& rows, const std::vector<bool>& drop) {
  MotionRows some = rows;
  some.features.clear();
  some.near.clear();
  some.far.clear();
  some.terms = static_cast<std::size_t>(std::count(drop.begin(), drop.end(), false));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t c = 0; c <= rows.terms; ++c) {
      if (c < rows.terms && drop[c]) continue;
      some.features.push_back(rows.features[k * (rows.terms + 1) + c]);
      some.near.push_back(rows.near[k * (rows.terms + 1) + c]);
      some.far.push_back(rows.far[k * (rows.terms + 1) + c]);
    }
  }
  return some;
}

double MeanSquare(const std::vector<Vec3d>& values) {
  double sum = 0;
  for (const Vec3d& v : values) sum += SquaredNorm(v);
  return values.empty() ? 0 : sum / (3.0 * static_cast<double>(values.size()));
}

// c_i of each animal from past directions: sum g u / sum g n; NaN for an animal without rows.
std::vector<double> OwnFactors(const MotionRows& rows, const std::vector<double>& theta,
                               int animals) {
  const auto n = static_cast<std::size_t>(animals);
  const std::vector<Vec3d> u = Unexplained(rows, theta, false);
  std::vector<double> products(n), squares(n), factors(n);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t at = k * (rows.terms + 1) + rows.terms;
    const auto animal = static_cast<std::size_t>(rows.animal[k]);
    products[animal] += Dot(rows.near[at], u[k]);
    squares[animal] += Dot(rows.near[at], rows.features[at]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    factors[i] =
        squares[i] > 0 ? products[i] / squares[i] : std::numeric_limits<double>::quiet_NaN();
  }
  return factors;
}

// 1 - sum |y - prediction|^2 / sum |y|^2 over the last share of the time, the prediction made of
// the states before each window by weights that know the time before only.
std::optional<double> HeldOutR2(const FitOptions& options, const WhiteningOptions& whitening,
                                const MotionRows& rows, const ObservedFlock& flock) {
  const FrameSpan span = flock.span();
  const int split =
      span.last - static_cast<int>(options.held_out * (span.last - span.first + 1)) + 1;
  const MotionRows train = Filtered(rows, [&](int frame) { return frame + rows.window < split; });
  const MotionRows test = Filtered(rows, [&](int frame) { return frame - rows.window >= split; });
  if (test.size() < 10) return std::nullopt;
  const WhitenedFit fit = SolveWhitened(whitening, train);
  if (!fit.IsUsable()) return std::nullopt;
  const std::vector<double>& theta = fit.regression.estimate;
  std::vector<double> own(static_cast<std::size_t>(flock.animals()), 0.0);
  if (whitening.own_speed) own = OwnFactors(train, theta, flock.animals());
  double left = 0, all = 0;
  for (std::size_t k = 0; k < test.size(); ++k) {
    const double factor = own[static_cast<std::size_t>(test.animal[k])];
    if (std::isnan(factor)) continue;
    const std::size_t at = k * (test.terms + 1);
    Vec3d prediction = test.near_known[k] + factor * test.near[at + test.terms];
    for (std::size_t c = 0; c < test.terms; ++c) prediction += theta[c] * test.near[at + c];
    left += SquaredNorm(test.response[k] - prediction);
    all += SquaredNorm(test.response[k]);
  }
  if (all == 0) return std::nullopt;
  return 1 - left / all;
}

// Share of u that a pull to the flock's mean position explains, 0 when it pushes outwards.
double PullToTheMiddle(const MotionRows& rows, const std::vector<Vec3d>& u) {
  Vec3d mean;
  for (const Vec3d& x : rows.position) mean += x;
  mean = mean / static_cast<double>(std::max<std::size_t>(rows.size(), 1));
  double product = 0, squares_x = 0, squares_u = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Vec3d inwards = mean - rows.position[k];
    product += Dot(inwards, u[k]);
    squares_x += SquaredNorm(inwards);
    squares_u += SquaredNorm(u[k]);
  }
  if (product <= 0 || squares_x == 0 || squares_u == 0) return 0;
  return product * product / (squares_x * squares_u);
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
    ModelSpec model = CompleteModel(problem_.model);
    std::vector<std::string> free = problem_.free.empty() ? DefaultFree(problem_) : problem_.free;
    if (!problem_.walls && std::find(free.begin(), free.end(), "alpha_b") != free.end()) {
      throw InputError(problem_.model.where, 0, "alpha_b is to be fitted, but there are no walls",
                       "say where the walls are, or leave alpha_b out");
    }
    WidenSpeedLimits(problem_, flock_, &model, &result_.warnings);
    terms_ = MakeFlockTerms(model, free, problem_.walls);
    result_.parameters.model = model;
    result_.animals = flock_.animals();
    const FrameSpan span = flock_.span();
    result_.frames = span.last - span.first + 1;
    if (!(SecondDifferenceMeanSquare(flock_, 1) >= 0)) {
      result_.status = flock_.animals() == 0 ? FitStatus::kTooFewAnimals : FitStatus::kTooFewFrames;
      return std::move(result_);
    }
    ChooseRows();
    const MotionRows rows = Rows(flock_, progress);
    whitening_.lagged = !options_.plain;
    whitening_.own_speed = terms_.has_own_speed;
    whitening_.stride = stride_;
    const bool depth_errors = trajectories_.has_sd_depth;
    if (depth_errors) {
      whitening_.sight = [this](int frame, const Vec3d& position) {
        return DepthDirection(problem_.camera, frame, position);
      };
    }
    WhitenedFit fit = SolveWhitened(whitening_, rows);
    if (fit.IsUsable() && fit.depth_variance > 0) {
      whitening_.depth_variance = fit.depth_variance;
      fit = SolveWhitened(whitening_, rows);
    }
    if (!fit.IsUsable()) {
      result_.status = fit.regression.status == RegressionStatus::kTooFewTimes
                           ? FitStatus::kTooFewFrames
                           : FitStatus::kTooFewRows;
      return std::move(result_);
    }
    Summarize(rows, fit);
    if (options_.held_out > 0) {
      result_.r2_held_out = HeldOutR2(options_, whitening_, rows, flock_);
    }
    if (depth_errors && options_.depth_draws > 0) AddDepthFactors(fit);
    Warn(rows, fit);
    return std::move(result_);
  }

 private:
  void ChooseRows() {
    window_ = options_.window > 0 ? options_.window : ChooseWindow(flock_, options_.longest_window);
    result_.window = window_;
    std::int64_t points = 0;
    for (int f = flock_.span().first; f <= flock_.span().last; ++f) points += flock_.Count(f);
    stride_ = static_cast<int>((points + options_.max_rows - 1) / options_.max_rows);
    middles_ = Middles(flock_, window_, stride_);
  }

  MotionRows Rows(const ObservedFlock& flock, const Progress& progress) const {
    return BuildMotionRows({.window = window_, .substeps = options_.substeps, .threads = threads_},
                           terms_, flock, middles_, progress);
  }

  void Summarize(const MotionRows& rows, const WhitenedFit& fit) {
    const std::vector<double>& theta = fit.regression.estimate;
    const std::size_t p = theta.size();
    result_.rows = static_cast<std::int64_t>(rows.size());
    result_.rows_mixed = rows.mixed;
    result_.rows_clamped = std::count(rows.clamped.begin(), rows.clamped.end(), true);
    result_.condition = fit.regression.condition;
    u_ = Unexplained(rows, theta, whitening_.own_speed);
    result_.acceleration_sd = std::sqrt(MeanSquare(rows.response));
    result_.residual_sd = std::sqrt(MeanSquare(u_));
    result_.r2 = 1 - MeanSquare(u_) / std::max(MeanSquare(rows.response), 1e-300);

    std::vector<double> rms(p);
    for (std::size_t c = 0; c < p; ++c) {
      std::vector<Vec3d> term;
      for (std::size_t k = 0; k < rows.size(); ++k) term.push_back(rows.features[k * (p + 1) + c]);
      rms[c] = std::sqrt(MeanSquare(term));
    }
    std::vector<Vec3d> explained;
    for (std::size_t k = 0; k < rows.size(); ++k) explained.push_back(rows.response[k] - u_[k]);
    const double model_rms = std::sqrt(MeanSquare(explained));

    WhiteningOptions least_squares = whitening_;
    least_squares.lagged = false;
    const WhitenedFit plain = SolveWhitened(least_squares, rows);
    for (std::size_t c = 0; c < p; ++c) {
      FittedWeight weight;
      weight.name = terms_.free[c];
      weight.estimate = theta[c];
      weight.sd = fit.regression.sd[c];
      weight.plain = plain.regression.estimate[c];
      const double half_width = 1.96 * weight.sd;
      weight.determined = std::isfinite(weight.sd) && (half_width < std::abs(weight.estimate) ||
                                                       half_width * rms[c] < 0.25 * model_rms);
      if (rms[c] == 0) weight.estimate = result_.parameters.model.parameters.at(weight.name);
      weight.value = weight.estimate;
      result_.weights.push_back(weight);
    }
    Directions(fit.regression, rms);
    EnforceLegalRange(rows);
    DescribeNoise(rows, fit);
    if (whitening_.own_speed) DescribeOwnSpeeds(rows);
    ParameterPosterior& posterior = result_.parameters.posterior;
    posterior.correlation = fit.regression.correlation;
    for (const FittedWeight& weight : result_.weights) {
      posterior.free.push_back(weight.name);
      posterior.sd.push_back(weight.sd);
      posterior.determined.push_back(weight.determined);
      result_.parameters.model.parameters[weight.name] = weight.value;
    }
  }

  // Weights below the model's least value are set to it, and the others fitted again.
  void EnforceLegalRange(const MotionRows& rows) {
    const std::size_t p = result_.weights.size();
    std::vector<bool> drop(p, false);
    const ModelInfo* const info = FindModel(result_.parameters.model.name);
    const auto low = [&](const std::string& name) {
      const auto found = std::find_if(info->parameters.begin(), info->parameters.end(),
                                      [&](const ParameterInfo& i) { return i.name == name; });
      return found->range.low;
    };
    for (bool again = true; again;) {
      again = false;
      for (std::size_t c = 0; c < p; ++c) {
        FittedWeight& weight = result_.weights[c];
        if (drop[c] || weight.value >= low(weight.name)) continue;
        drop[c] = again = true;
        weight.value = 0;
      }
      if (!again || std::count(drop.begin(), drop.end(), false) == 0) break;
      const WhitenedFit fit = SolveWhitened(whitening_, WithoutTerms(rows, drop));
      if (!fit.IsUsable()) break;
      for (std::size_t c = 0, kept = 0; c < p; ++c) {
        if (!drop[c]) result_.weights[c].value = fit.regression.estimate[kept++];
      }
    }
  }

  void DescribeNoise(const MotionRows& rows, const WhitenedFit& fit) {
    const double width = window_ * flock_.dt();
    auto& parameters = result_.parameters.model.parameters;
    if (fit.rho && *fit.rho > 0) {
      const int lag = 2 * window_ + 3;
      const double time = -width / std::log(*fit.rho);
      const double near = CorrelationAtLag(rows, u_, lag).covariance;
      result_.noise_time = time;
      result_.noise_sd = std::sqrt(std::max(0.0, near) * std::exp(lag * flock_.dt() / time));
    } else {
      // Under the triangle, noise that is fresh at every instant has a variance V and a quarter of
      // it at lag m; position noise has 6 M and -4 M.
      const double here = MeanSquare(u_), there = CorrelationAtLag(rows, u_, window_).covariance;
      const double variance = std::max(0.0, (4 * here + 6 * there) / 5.5);
      result_.diffusion = 0.75 * width * variance;
      const double step = flock_.dt() / std::max(1, options_.substeps);
      result_.noise_sd = std::sqrt(2 * result_.diffusion / step);
    }
    if (parameters.contains("noise") && parameters.contains("time_unit")) {
      const double unit = parameters.at("time_unit");
      parameters["noise"] = result_.noise_sd * unit * unit;
      parameters["noise_time"] = result_.noise_time / unit;
    }
    if (parameters.contains("diffusion")) parameters["diffusion"] = result_.diffusion;
  }

  void DescribeOwnSpeeds(const MotionRows& rows) {
    std::vector<double> theta;
    for (const FittedWeight& weight : result_.weights) theta.push_back(weight.value);
    const auto& parameters = result_.parameters.model.parameters;
    double cruise = parameters.at("cruise");
    for (const FittedWeight& weight : result_.weights) {
      if (weight.name == "cruise") cruise = weight.value;
    }
    if (!(cruise > 0)) return;
    double sum = 0, squares = 0, count = 0;
    for (const double factor : OwnFactors(rows, theta, flock_.animals())) {
      if (std::isnan(factor)) continue;
      const double speed = factor / (cruise / parameters.at("time_unit"));
      sum += speed;
      squares += speed * speed;
      count += 1;
    }
    if (count == 0) return;
    result_.own_speed_mean = sum / count;
    result_.own_speed_sd = std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
  }

  void Directions(const RegressionResult& regression, const std::vector<double>& rms) {
    std::vector<Eigen::Index> known;
    for (std::size_t c = 0; c < rms.size(); ++c) {
      if (std::isfinite(regression.sd[c])) known.push_back(static_cast<Eigen::Index>(c));
    }
    if (known.empty()) return;
    const auto n = static_cast<Eigen::Index>(known.size());
    Eigen::MatrixXd covariance(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto a = static_cast<std::size_t>(known[static_cast<std::size_t>(i)]);
        const auto b = static_cast<std::size_t>(known[static_cast<std::size_t>(j)]);
        covariance(i, j) = regression.correlation[a * rms.size() + b] * regression.sd[a] *
                           regression.sd[b] * rms[a] * rms[b];
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
    const auto direction = [&](Eigen::Index column) {
      FitDirection result{.weights = std::vector<double>(rms.size(), 0.0), .sd = 0};
      Eigen::VectorXd vector = eigen.eigenvectors().col(column);
      Eigen::Index largest = 0;
      vector.cwiseAbs().maxCoeff(&largest);
      if (vector[largest] < 0) vector = -vector;
      for (Eigen::Index i = 0; i < n; ++i) {
        result.weights[static_cast<std::size_t>(known[static_cast<std::size_t>(i)])] = vector[i];
      }
      result.sd = std::sqrt(std::max(0.0, eigen.eigenvalues()[column]));
      return result;
    };
    result_.best = direction(0);
    result_.worst = direction(n - 1);
  }

  // Simulation extrapolation: what one more error of the stated size does.
  void AddDepthFactors(const WhitenedFit& fit) {
    const std::size_t p = terms_.free.size();
    std::vector<double> sums(p), squares(p);
    int draws = 0;
    for (int draw = 0; draw < options_.depth_draws; ++draw) {
      const DepthNoiseOptions noise{.time = options_.depth_error_time,
                                    .scale_sd = options_.scale_sd,
                                    .seed = seed_,
                                    .draw = static_cast<std::uint32_t>(draw)};
      const Trajectories noisy = AddDepthNoise(noise, problem_.camera, fps_, trajectories_);
      const WhitenedFit again =
          SolveWhitened(whitening_, Rows(ObservedFlock(noisy, fps_, options_.bridged_gap), {}));
      if (!again.IsUsable()) continue;
      ++draws;
      for (std::size_t c = 0; c < p; ++c) {
        const double factor = again.regression.estimate[c] / fit.regression.estimate[c];
        sums[c] += factor;
        squares[c] += factor * factor;
      }
    }
    if (draws < 2) return;
    for (std::size_t c = 0; c < p; ++c) {
      const double mean = sums[c] / draws;
      if (!std::isfinite(mean)) continue;
      result_.weights[c].depth_factor = mean;
      result_.weights[c].depth_factor_sd =
          std::sqrt(std::max(0.0, squares[c] / draws - mean * mean) / (draws - 1));
    }
  }

  void Warn(const MotionRows& rows, const WhitenedFit& fit) {
    auto& warnings = result_.warnings;
    if (options_.plain) {
      warnings.push_back(
          "plain least squares: the weights are biased, however long the data; their standard "
          "deviations do not show it");
    }
    if (result_.r2_held_out && *result_.r2_held_out <= 0) {
      warnings.push_back(fmt::format(
          "the model explains nothing: on the last {:.0f} % of the time it predicts accelerations "
          "no better than constant velocity does (R^2 {:.3f})",
          100 * options_.held_out, *result_.r2_held_out));
    }
    std::string undetermined, illegal;
    for (const FittedWeight& weight : result_.weights) {
      if (!weight.determined) undetermined += " " + weight.name;
      if (weight.value != weight.estimate && weight.value == 0) {
        illegal += fmt::format(" {} ({:.3g} +- {:.2g})", weight.name, weight.estimate, weight.sd);
      }
    }
    if (!undetermined.empty()) warnings.push_back("the data do not determine" + undetermined);
    if (!illegal.empty()) {
      warnings.push_back("set to 0, estimates are negative:" + illegal);
    }
    if (!fit.converged) {
      warnings.push_back(
          "what the model does not explain has a memory that could not be estimated: the weights "
          "may be biased");
    }
    const double clamped =
        static_cast<double>(result_.rows_clamped + result_.rows_mixed) /
        static_cast<double>(std::max<std::int64_t>(1, result_.rows + result_.rows_mixed));
    if (clamped > kTooManyClamped) {
      warnings.push_back(fmt::format(
          "{:.0f} % of the animals' speeds are at the model's limits: check s_min and s_max",
          100 * clamped));
    }
    const double pull = problem_.walls ? 0 : PullToTheMiddle(rows, u_);
    if (pull > kConfining) {
      warnings.push_back(fmt::format(
          "something that the model lacks holds the flock together or in place: a pull to the "
          "middle explains {:.0f} % of what it leaves over; if there are walls, say where",
          100 * pull));
    }
    WarnOfDepth(warnings);
  }

  void WarnOfDepth(std::vector<std::string>& warnings) const {
    std::string factors;
    for (const FittedWeight& weight : result_.weights) {
      if (!weight.depth_factor) continue;
      factors += fmt::format("{} {} by {:.2f} +- {:.2f}", factors.empty() ? "" : ",", weight.name,
                             *weight.depth_factor, *weight.depth_factor_sd);
    }
    if (factors.empty()) return;
    std::vector<double> sds;
    for (const Trajectory& trajectory : trajectories_.trajectories) {
      for (const TrajectoryPoint& point : trajectory.points) sds.push_back(point.sd_depth);
    }
    std::nth_element(sds.begin(), sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 2),
                     sds.end());
    warnings.push_back(fmt::format(
        "depth errors (median sd {:.2g} m) distort the weights beyond their standard deviations: "
        "another error of that size multiplies{}; the true weights may be off by as much again",
        sds[sds.size() / 2], factors));
  }

  const FitOptions& options_;
  const FitProblem& problem_;
  const Trajectories& trajectories_;
  double fps_;
  std::uint64_t seed_;
  int threads_;
  ObservedFlock flock_;
  FlockTerms terms_;
  WhiteningOptions whitening_;
  int window_ = 1, stride_ = 1;
  std::vector<int> middles_;
  std::vector<Vec3d> u_;
  FitResult result_;
};

}  // namespace

std::string StatusText(FitStatus status) {
  switch (status) {
    case FitStatus::kOk:
      return "fitted";
    case FitStatus::kTooFewAnimals:
      return "there are no animals to fit";
    case FitStatus::kTooFewFrames:
      return "too few frames: no animal has a run of frames that is long enough, or they span too "
             "little time";
    case FitStatus::kTooFewRows:
      return "too few animals and frames for so many weights: free fewer";
  }
  return "";
}

FitResult FitModel(const FitOptions& options, const FitProblem& problem,
                   const Trajectories& trajectories, double fps, std::uint64_t seed, int threads,
                   const Progress& progress) {
  CheckOptions(options);
  Check(fps > 0, "fps must be positive");
  return Fitter(options, problem, trajectories, fps, seed, threads).Run(progress);
}

}  // namespace flocklift
