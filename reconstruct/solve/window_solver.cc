// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/window_solver.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "reconstruct/cost_functions/path.h"
#include "reconstruct/cost_functions/size.h"
#include "reconstruct/solve/batch_model.h"
#include "reconstruct/solve/batch_start.h"
#include "reconstruct/solve/body_fit.h"
#include "reconstruct/solve/box_of_body.h"
#include "reconstruct/solve/curves.h"
#include "reconstruct/solve/read_out.h"
#include "reconstruct/solve/size_model.h"
#include "reconstruct/solve/spread_estimator.h"
#include "simulate/core/parallel_for.h"

namespace flocklift::internal {
namespace {

// Boxes that change their form less (box_form.h) are of a detector that knows but one form: it
// tells nothing of bodies.
constexpr double kLeastFormSd = 0.03;

// One round of estimating the spreads, at the present solution. Returns the covariance of the
// flock's unknowns.
Eigen::MatrixXd EstimateSpreads(const Spreads& guess, bool size_spread, BatchState* state,
                                BatchSolver* solver) {
  Eigen::MatrixXd covariance = solver->Linearize();
  constexpr double kInterval = 0.5;  // between the errors that are looked at [s]
  const int stride =
      std::max(1, static_cast<int>(std::lround(kInterval / state->model.knot_interval)));
  std::vector<SpreadEstimator> of_bird(state->birds.size(), SpreadEstimator(state->model.spreads));
  solver->ForEachBird([&](std::size_t i) {
    const Bird& bird = state->birds[i];
    const ArrowSystem& system = solver->work(i).system;
    const ArrowSystem::Posterior posterior = system.Covariance(covariance);
    of_bird[i].BeginAnimal((bird.knots - 1) * state->model.knot_interval);
    std::optional<ResidualRow> last_size;
    ForEachError(state->model, bird, state->shared, [&](Term term, const ResidualRow& row) {
      const bool on_stride = row.first / 3 % stride == 0;
      if (on_stride || term == Term::kDepth) {
        of_bird[i].Add(term, row.residual, system.VarianceOf(posterior, row));
      }
      if (term != Term::kSize) return;
      if (on_stride && last_size && last_size->first + 3 == row.first) {
        const ErrorPair pair(*last_size, row);
        of_bird[i].AddSizePair(pair.sum.residual, system.VarianceOf(posterior, pair.sum),
                               pair.difference.residual,
                               system.VarianceOf(posterior, pair.difference));
      }
      last_size = row;
    });
    ResidualRow own;
    own.AddBorder(kOwnLogSpeed, 1);
    own.AddBorder(kOwnUnknowns + kFlockLogSpeed, -1);
    of_bird[i].Add(Term::kSpeedSpread, bird.own[kOwnLogSpeed] - state->shared[kFlockLogSpeed],
                   system.VarianceOf(posterior, own));
    if (!size_spread) return;
    ResidualRow bias;
    bias.AddBorder(kOwnSizeBias, 1);
    of_bird[i].Add(Term::kSizeSpread, bird.own[kOwnSizeBias], system.VarianceOf(posterior, bias));
  });
  SpreadEstimator all(state->model.spreads);
  for (const SpreadEstimator& estimator : of_bird) all.Merge(estimator);
  const BatchModel& model = state->model;
  for (int i = model.turn.first; i < model.turn.end(); ++i) {
    all.Add(Term::kTurn, state->shared[i], covariance(i, i));
  }
  all.Update(guess, model.knot_interval, &state->model.spreads);
  for (Bird& bird : state->birds) {
    double sum = 0;
    for (std::size_t k = 2; k < bird.path.size(); k += 3) sum += bird.path[k];
    bird.reference_depth = std::exp(sum * 3 / static_cast<double>(bird.path.size()));
  }
  return covariance;
}

// Smoothness may hold a path in a reversal of depth, which the first search, with spreads not known
// yet, did not see. Each animal is searched anew; what is more probable is kept.
void TryOtherDepths(const ScaleGuess& guess, BatchState* state, BatchSolver* solver) {
  constexpr int kIterations = 20;
  solver->ForEachBird([&](std::size_t i) {
    Bird& bird = state->birds[i];
    Bird other = bird;
    SearchDepthAgain(state->model, guess, state->shared, &other);
    const double present = solver->MinimizeAlone(i, kIterations, &bird);
    if (solver->MinimizeAlone(i, kIterations, &other) < present) {
      std::swap(bird.path, other.path);
      bird.own = other.own;
    }
  });
}

// How sizes relate to the wingspan in these views, as far as headings are known now. `usual`: what
// was known before of birds; `wingspan_sd`: relative, of the flock's mean; infinite: not known.
// Returns how probably they are as large from every side.
double UpdateSizeModel(const BatchOptions& options, double wingspan_sd, const BoxForm& form,
                       const SizeModel& usual, bool body_is_seen, const Eigen::MatrixXd& covariance,
                       BatchState* state) {
  // What sizes may still differ by from those of a body whose form is known.
  constexpr Uncertain kTrunk{kUsualLogTrunk, 0.4}, kUp{kUsualLogUp, 0.7};
  BatchModel& model = state->model;
  const SizeModel used{model.size_ratio, model.log_trunk, model.log_up};
  static_assert(kLogTrunk == kSizeRatio + 1 && kLogUp == kSizeRatio + 2);
  const SizeLikelihood likelihood(state->shared.segment<3>(kSizeRatio),
                                  covariance.block<3, 3>(kSizeRatio, kSizeRatio), used);
  const bool known = std::isfinite(wingspan_sd);
  const auto expected = [&] {
    if (!known) return usual.ratio;
    return ExpectedBoxRatio(model, state->birds, state->shared,
                            std::hypot(options.size_ratio_sd, wingspan_sd));
  };
  SizeModel body = usual, stiff = StiffSizes(form);
  if (model.body.share > 0) {
    body.log_trunk = kTrunk;
    body.log_up = kUp;
  }
  body.ratio = expected();
  stiff.ratio.sd = std::hypot(stiff.ratio.sd, wingspan_sd);
  if (!known) stiff.ratio = usual.ratio;
  const double p = ProbabilityOfStiff(likelihood, form, body, stiff);
  if (body_is_seen) {
    const double before = body.ratio.mean;
    model.body.share = 1 - p;
    body = {expected(), kTrunk, kUp};
    state->shared[kSizeRatio] += body.ratio.mean - before;
  }
  const SizeModel next = Mixture(p, body, stiff);
  model.size_ratio = next.ratio;
  model.log_trunk = next.log_trunk;
  model.log_up = next.log_up;
  return p;
}

// When a solution stands still, in units of log likelihood.
BatchSolver::Standstill Finally(const std::vector<Bird>& birds) {
  return {.fall = 2e-4 * static_cast<double>(birds.size()), .times = 3};
}

}  // namespace

SolvedWindow SolveWindow(const BatchOptions& options, const Knowledge& knowledge,
                         const Segments& segments, const std::optional<Belief>& belief,
                         int first_frame, double fps, int threads,
                         const std::function<void()>& on_iteration, const WindowRefiner& refine) {
  SolvedWindow solved;
  BatchReport& report = solved.result.report;
  const ScaleGuess guess = WithBelief(GuessScale(knowledge, segments), knowledge, belief);
  BatchState state;
  state.model = MakeModel(options, knowledge, segments, guess, belief, fps);
  state.model.on_iteration = on_iteration;
  state.shared = StartOfShared(state.model);
  state.birds.resize(segments.segments.size());
  ParallelFor(threads, 0, static_cast<std::int64_t>(state.birds.size()), 1,
              [&](std::int64_t first, std::int64_t last) {
                for (std::int64_t i = first; i < last; ++i) {
                  state.birds[i] = StartBird(state.model, knowledge, guess, segments.segments[i],
                                             fps, first_frame);
                }
              });

  BatchSolver solver(&state, threads);
  report.initial_cost = solver.Cost();
  const auto minimize = [&](int most, const BatchSolver::Standstill& standstill) {
    report.converged =
        solver.Minimize(std::min(most, options.max_iterations), standstill, &report.iterations);
  };
  // In units of log likelihood. While the spreads change there is less to wait for.
  const double animals = static_cast<double>(state.birds.size());
  const BatchSolver::Standstill roughly{.fall = 0.01 * animals, .times = 1};
  const BatchSolver::Standstill finally = Finally(state.birds);
  if (!options.estimate) minimize(options.max_iterations, finally);
  if (options.estimate) {
    minimize(kStartIterations, roughly);
    const Spreads first_guess = state.model.spreads;
    const BatchModel& model = state.model;
    const SizeModel usual{model.size_ratio, model.log_trunk, model.log_up};
    const Uncertain usual_lean = model.lean;
    const bool size_is_seen = model.use_size && !model.belief && !model.erratic;
    const double wingspan_sd =
        knowledge.wingspan ? first_guess.size_between : std::numeric_limits<double>::infinity();
    const bool size_spread = knowledge.wingspan && knowledge.speed && model.use_size;
    for (int round = 0; round < kSpreadRounds; ++round) {
      const Eigen::MatrixXd covariance = EstimateSpreads(first_guess, size_spread, &state, &solver);
      UpdateCurves(state.model, &state.birds);
      if (size_is_seen) {
        const bool body_is_seen = segments.form.sd > kLeastFormSd &&
                                  FitBody(segments, usual_lean, state.birds, &state.model);
        const double stiff = UpdateSizeModel(options, wingspan_sd, segments.form, usual,
                                             body_is_seen, covariance, &state);
        if (knowledge.wingspan) report.stiff_boxes = stiff;
        report.weak_perspective = model.body.Perspective() < 0.5;
      }
      minimize(kSpreadIterations, roughly);
      if (!model.erratic && (round == kFirstSearch || round == kSecondSearch)) {
        TryOtherDepths(guess, &state, &solver);
      }
    }
    minimize(options.max_iterations, finally);
  }
  std::optional<DepthPosterior> posterior;
  if (refine) {
    const auto variances = [&] {
      BatchResult unrefined;
      ReadOut(&state, &solver, &unrefined);
      const double scale = unrefined.report.scale_sd * unrefined.report.scale_sd;
      std::vector<std::vector<double>> all;
      for (const SolvedPath& path : unrefined.paths) {
        std::vector<double>& own = all.emplace_back();
        for (const SolvedPoint& p : path) {
          own.push_back(std::max(0.0, p.sd_log_depth * p.sd_log_depth - scale));
        }
      }
      return all;
    };
    refine({segments, state, &posterior, variances, &report.dynamics});
  }
  report.final_cost = solver.Cost();
  const Eigen::MatrixXd covariance = ReadOut(&state, &solver, &solved.result);
  if (posterior) {
    const double scale = report.scale_sd * report.scale_sd;
    for (std::size_t i = 0; i < state.birds.size(); ++i) {
      for (std::size_t k = 0; k < state.birds[i].places.size(); ++k) {
        double& sd = solved.result.paths[i][k].sd_log_depth;
        const double own = std::max(0.0, sd * sd - scale);
        sd = std::sqrt((1 - posterior->weight) * own + posterior->variances[i][k] + scale);
      }
    }
  }
  CollectTerms(state, &report);
  solved.belief = {state.shared.head<kFlockScalars>(),
                   covariance.topLeftCorner<kFlockScalars, kFlockScalars>().inverse(),
                   state.model.body};
  return solved;
}

BatchState SolveAgain(const BatchState& solved, const Segments& segments, int max_iterations,
                      int threads) {
  BatchState state{solved.model, {}, solved.shared};
  for (std::size_t i = 0; i < solved.birds.size(); ++i) {
    state.birds.push_back(WithSightings(state.model, segments.segments[i], solved.birds[i]));
  }
  UpdateCurves(state.model, &state.birds);
  int iterations = 0;
  BatchSolver(&state, threads).Minimize(max_iterations, Finally(state.birds), &iterations);
  return state;
}

}  // namespace flocklift::internal
