// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/batch_problem.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/cost_functions/acceleration.h"
#include "reconstruct/cost_functions/erratic_flight.h"
#include "reconstruct/cost_functions/level_flight.h"
#include "reconstruct/cost_functions/size.h"
#include "reconstruct/cost_functions/speed.h"
#include "reconstruct/solve/knot_errors.h"
#include "reconstruct/solve/point_rows.h"

namespace flocklift::internal {
namespace {

// The shared depth says where an animal is, not how it gets there: it counts at a few knots, each
// independent of the others, spread evenly over the path.
bool CountsForDepth(const BatchModel& model, const Bird& bird, int knot) {
  const double knots = model.spreads.depth.time / model.knot_interval;
  const int count = std::max(1, static_cast<int>(std::lround(bird.knots / knots)));
  const auto passed = [&](int k) { return (2 * k * count + bird.knots) / (2 * bird.knots); };
  return passed(knot) != passed(knot - 1);
}

// All Markov errors of one knot that are asked for, in a fixed order.
template <typename Evaluation, typename Take>
void ForEachKnotError(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
                      RowKind kind, int knot, const Take& take) {
  const double rate = 1 / model.knot_interval;
  const double time = (bird.first_knot + knot) * model.knot_interval;
  const double* c = &bird.path[3 * static_cast<std::size_t>(knot)];
  const CameraMotion camera = model.camera.At(time);
  const Evaluation evaluate(c, rate);
  const auto minus = [&](const FlockCurve& curve, int axis, auto error) {
    if (curve.knots == 0) return error;
    for (const FlockCurve::Share& share : curve.At(time, axis)) error.Subtract(share, shared);
    return error;
  };
  constexpr std::array<BorderScalar, 0> kNone{};

  if (kind == RowKind::kAll) {
    const AccelerationError acceleration{
        .rate = rate, .reference_depth = bird.reference_depth, .camera = camera};
    const auto a = evaluate.template Of<3, 3>(
        kNone, [&](const auto& q, const auto*, auto* error) { acceleration.Of(q, error); });
    for (int axis = 0; axis < 3; ++axis) {
      take(Term::kAcceleration, axis, minus(model.turn, axis, a[axis]));
    }
  }

  const std::array mean_speed{BorderScalar{bird.own[kOwnLogSpeed], kOwnLogSpeed}};
  if (model.erratic) {
    const ErraticFlightError speed{.rate = rate, .softening = bird.softening, .camera = camera};
    const auto both = evaluate.template Of<2, 2>(
        mean_speed, [&](const auto& q, const auto* x, auto* error) { speed.Of(q, x[0], error); });
    take(Term::kSpeed, 0, both[0]);
    take(Term::kAlong, 0, both[1]);
  } else {
    const SpeedError speed{.rate = rate, .softening = bird.softening, .camera = camera};
    take(Term::kSpeed, 0,
         evaluate.template Of<1, 2>(mean_speed, [&](const auto& q, const auto* x, auto* error) {
           speed.Of(q, x[0], error);
         })[0]);
  }

  if (model.use_climb && model.up_in_cam) {
    const LevelFlightError level{
        .rate = rate, .softening = bird.softening, .up_in_cam = *model.up_in_cam, .camera = camera};
    take(Term::kClimb, 0,
         evaluate.template Of<1, 2>(
             kNone, [&](const auto& q, const auto*, auto* error) { level.Of(q, error); })[0]);
  }
  if (model.use_size && bird.size[knot]) {
    const SizeError size{.rate = rate,
                         .softening = bird.softening,
                         .log_size = *bird.size[knot],
                         .log_wingspan = model.log_wingspan,
                         .up_in_cam = model.up_in_cam,
                         .curve = bird.curve[knot],
                         .camera = camera,
                         .body = &model.body.image,
                         .body_share = model.body.share,
                         .perspective = model.body.Perspective()};
    const auto flocks = [&](int k) { return BorderScalar{shared[k], kOwnUnknowns + k}; };
    take(Term::kSize, 0,
         evaluate.template Of<1, 2>(
             std::array{BorderScalar{bird.own[kOwnSizeBias], kOwnSizeBias}, flocks(kSizeRatio),
                        flocks(kLogTrunk), flocks(kLogUp), flocks(kLean)},
             [&](const auto& q, const auto* x, auto* error) {
               size.Of(q, x[0], x[1], x[2], x[3], x[4], error);
             })[0]);
  }
  if (model.use_depth && CountsForDepth(model, bird, knot)) {
    take(Term::kDepth, 0, minus(model.depth, 0, evaluate.LogDepth()));
  }
}

template <typename Evaluation>
void TakeMarkovRows(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
                    RowKind kind, const RowSink& take) {
  using Rows = MarkovRows<typename Evaluation::Error>;
  const Spreads& s = model.spreads;
  const double dt = model.knot_interval;
  std::array<Rows, 3> acceleration = {Rows(Term::kAcceleration, s.acceleration, dt),
                                      Rows(Term::kAcceleration, s.acceleration, dt),
                                      Rows(Term::kAcceleration, s.acceleration, dt)};
  Rows speed(Term::kSpeed, s.speed, dt), along(Term::kAlong, s.along, dt);
  Rows climb(Term::kClimb, s.climb, dt);
  Rows size(Term::kSize, s.size, dt), depth(Term::kDepth, s.depth, dt);
  for (int knot = 0; knot < bird.knots; ++knot) {
    ForEachKnotError<Evaluation>(model, bird, shared, kind, knot,
                                 [&](Term term, int axis, const auto& error) {
                                   Rows& rows = term == Term::kAcceleration ? acceleration[axis]
                                                : term == Term::kSpeed      ? speed
                                                : term == Term::kAlong      ? along
                                                : term == Term::kClimb      ? climb
                                                : term == Term::kSize       ? size
                                                                            : depth;
                                   rows.Push(knot, error, take);
                                 });
  }
}

void TakeIndividual(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
                    const RowSink& take) {
  ResidualRow speed;
  speed.residual = (bird.own[kOwnLogSpeed] - shared[kFlockLogSpeed]) / model.spreads.speed_between;
  speed.AddBorder(kOwnLogSpeed, 1 / model.spreads.speed_between);
  speed.AddBorder(kOwnUnknowns + kFlockLogSpeed, -1 / model.spreads.speed_between);
  take(Term::kSpeedSpread, speed);
  ResidualRow size;
  size.residual = bird.own[kOwnSizeBias] / model.spreads.size_between;
  size.AddBorder(kOwnSizeBias, 1 / model.spreads.size_between);
  take(Term::kSizeSpread, size);
}

}  // namespace

void ForEachRow(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
                bool derivatives, const RowSink& take, RowKind kind) {
  TakeReprojections(bird, derivatives, take);
  TakeViews(bird, take);
  const auto take_markov =
      derivatives ? TakeMarkovRows<SlopesAtKnot> : TakeMarkovRows<ValuesAtKnot>;
  take_markov(model, bird, shared, kind, take);
  TakeAnchors(bird, take);
  TakeBounds(model, bird, take);
  TakeAnyVelocity(model, bird, take);
  TakeIndividual(model, bird, shared, take);
}

void ForEachError(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
                  const RowSink& take) {
  for (int knot = 0; knot < bird.knots; ++knot) {
    ForEachKnotError<SlopesAtKnot>(model, bird, shared, RowKind::kAll, knot,
                                   [&](Term term, int /*axis*/, const ErrorSlopes& error) {
                                     ResidualRow row;
                                     row.first = 3 * knot;
                                     error.AddTo(1, 0, &row);
                                     take(term, row);
                                   });
  }
}

double CostOf(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
              RowKind kind) {
  double cost = 0;
  const auto add = [&](Term term, const ResidualRow& row) {
    cost += RobustCost(term, row.residual);
  };
  ForEachRow(model, bird, shared, false, add, kind);
  return cost;
}

double SharedPriors(const BatchModel& model, const Eigen::VectorXd& shared, Eigen::MatrixXd* matrix,
                    Eigen::VectorXd* gradient) {
  double cost = 0;
  // (x_i - rho x_j - mean) / sd, without x_j where j < 0
  const auto add = [&](int i, int j, double rho, double mean, double sd) {
    const double r = (shared[i] - (j >= 0 ? rho * shared[j] : 0) - mean) / sd;
    cost += 0.5 * r * r;
    if (matrix == nullptr) return;
    const double w = 1 / (sd * sd);
    (*matrix)(i, i) += w;
    (*gradient)[i] += r / sd;
    if (j < 0) return;
    (*matrix)(j, j) += rho * rho * w;
    (*matrix)(i, j) -= rho * w;
    (*matrix)(j, i) -= rho * w;
    (*gradient)[j] -= rho * r / sd;
  };
  if (model.belief) {
    const Belief::Vector off = shared.head<kFlockScalars>() - model.belief->mean;
    const Belief::Vector pull = model.belief->information * off;
    cost += 0.5 * off.dot(pull);
    if (matrix != nullptr) {
      matrix->topLeftCorner<kFlockScalars, kFlockScalars>() += model.belief->information;
      gradient->head<kFlockScalars>() += pull;
    }
  } else {
    add(kFlockLogSpeed, -1, 0, model.flock_log_speed.mean, model.flock_log_speed.sd);
    add(kSizeRatio, -1, 0, model.size_ratio.mean, model.size_ratio.sd);
    add(kLogTrunk, -1, 0, model.log_trunk.mean, model.log_trunk.sd);
    add(kLogUp, -1, 0, model.log_up.mean, model.log_up.sd);
    add(kLean, -1, 0, model.lean.mean, model.lean.sd);
  }
  for (int k = 0; k < model.depth.knots; ++k) {
    const int i = model.depth.first + k;
    add(i, -1, 0, model.log_depth.mean,
        model.log_depth.sd * std::sqrt(static_cast<double>(model.depth.knots)));
    if (k > 0) add(i, i - 1, 1, 0, model.depth_step_sd);
  }
  const auto wander = [&](const FlockCurve& curve, const MarkovProcess& process) {
    const double rho = process.Correlation(curve.interval);
    for (int i = curve.first; i < curve.end(); ++i) {
      const bool begins = i < curve.first + curve.width;
      add(i, begins ? -1 : i - curve.width, rho, 0, begins ? process.sd : process.StepSd(rho));
    }
  };
  wander(model.turn, model.spreads.turn);
  return cost;
}

}  // namespace flocklift::internal
