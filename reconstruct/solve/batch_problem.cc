// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/batch_problem.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "reconstruct/cost_functions/acceleration.h"
#include "reconstruct/cost_functions/level_flight.h"
#include "reconstruct/cost_functions/size.h"
#include "reconstruct/cost_functions/speed.h"
#include "reconstruct/solve/point_rows.h"

namespace flocklift::internal {
namespace {

constexpr int kPathWidth = 9;  // unknowns of three control points

// An error at one knot with its derivatives by the three control points around it and the border.
struct Feature {
  double value = 0;
  std::array<double, kPathWidth> path{};
  std::array<std::pair<int, double>, 5> border;
  int border_count = 0;

  void Subtract(const FlockCurve& curve, double time, int axis, const Eigen::VectorXd& shared) {
    if (curve.knots == 0) return;
    for (const FlockCurve::Share& share : curve.At(time, axis)) {
      value -= share.weight * shared[share.index];
      border[border_count++] = {kOwnUnknowns + share.index, -share.weight};
    }
  }
};

// Evaluates an error functor of a path's state at a knot and `Extra` further scalars, whose places
// in the border are `places`. The state has `Orders` times three entries that count: x/z, y/z, log
// z, their slopes, and their curves. Derivatives by the few of them are cheaper than by the control
// points, in which the state is linear (path.h).
template <int Size, int Orders, int Extra, typename Error>
std::array<Feature, Size> Evaluate(bool derivatives, const double* path, double rate,
                                   const std::array<double, Extra>& extra,
                                   const std::array<int, Extra>& places, const Error& error) {
  std::array<Feature, Size> features;
  const PathState<double> q = StateAtKnot(path, rate);
  if (!derivatives) {
    std::array<double, Size> values;
    error(q, extra.data(), values.data());
    for (int a = 0; a < Size; ++a) features[a].value = values[a];
    return features;
  }
  constexpr int kState = 3 * Orders;
  using Jet = ceres::Jet<double, kState + Extra>;
  PathState<Jet> state{Jet(q.x, 0),  Jet(q.y, 1), Jet(q.l, 2), Jet(q.dx, 3), Jet(q.dy, 4),
                       Jet(q.dl, 5), Jet(q.ddx),  Jet(q.ddy),  Jet(q.ddl)};
  if constexpr (Orders == 3) {
    state.ddx.v[6] = state.ddy.v[7] = state.ddl.v[8] = 1;
  }
  std::array<Jet, Extra> x;
  for (int a = 0; a < Extra; ++a) x[a] = Jet(extra[a], kState + a);
  std::array<Jet, Size> values;
  error(state, x.data(), values.data());
  const double rate2 = rate * rate;
  const std::array<std::array<double, 3>, 3> of_control = {
      {{1.0 / 6, 4.0 / 6, 1.0 / 6}, {-0.5 * rate, 0, 0.5 * rate}, {rate2, -2 * rate2, rate2}}};
  for (int a = 0; a < Size; ++a) {
    features[a].value = values[a].a;
    for (int order = 0; order < Orders; ++order) {
      for (int b = 0; b < kPathWidth; ++b) {
        features[a].path[b] += of_control[order][b / 3] * values[a].v[3 * order + b % 3];
      }
    }
    for (int b = 0; b < Extra; ++b) {
      features[a].border[b] = {places[b], values[a].v[kState + b]};
    }
    features[a].border_count = Extra;
  }
  return features;
}

// Turns the errors of successive knots into independent unit residuals (markov.h). A gap starts
// the process afresh.
class MarkovRows {
 public:
  MarkovRows(Term term, const MarkovProcess& process, double dt)
      : term_(term),
        sd_(process.sd),
        rho_(process.Correlation(dt)),
        step_sd_(process.StepSd(rho_)) {}

  void Push(int knot, const Feature& feature, bool derivatives, const RowSink& take) {
    ResidualRow row;
    if (!derivatives) {
      const bool goes_on = knot == knot_ + 1;
      row.residual =
          goes_on ? (feature.value - rho_ * before_.value) / step_sd_ : feature.value / sd_;
      before_.value = feature.value;
      knot_ = knot;
      take(term_, row);
      return;
    }
    if (knot == knot_ + 1) {
      row.first = 3 * knot_;
      row.residual = (feature.value - rho_ * before_.value) / step_sd_;
      const double now = 1 / step_sd_, past = rho_ / step_sd_;
      for (int a = 0; a < kPathWidth; ++a) {
        row.path[a] -= past * before_.path[a];
        row.path[a + 3] += now * feature.path[a];
      }
      for (int a = 0; a < before_.border_count; ++a) {
        row.AddBorder(before_.border[a].first, -past * before_.border[a].second);
      }
      for (int a = 0; a < feature.border_count; ++a) {
        row.AddBorder(feature.border[a].first, now * feature.border[a].second);
      }
    } else {
      row.first = 3 * knot;
      row.residual = feature.value / sd_;
      for (int a = 0; a < kPathWidth; ++a) row.path[a] = feature.path[a] / sd_;
      for (int a = 0; a < feature.border_count; ++a) {
        row.AddBorder(feature.border[a].first, feature.border[a].second / sd_);
      }
    }
    take(term_, row);
    before_ = feature;
    knot_ = knot;
  }

 private:
  Term term_;
  double sd_, rho_, step_sd_;
  int knot_ = -2;
  Feature before_;
};

// The shared depth says where an animal is, not how it gets there: it counts at a few knots, each
// independent of the others, spread evenly over the path.
bool CountsForDepth(const BatchModel& model, const Bird& bird, int knot) {
  const double knots = model.spreads.depth.time / model.knot_interval;
  const int count = std::max(1, static_cast<int>(std::lround(bird.knots / knots)));
  const auto passed = [&](int k) { return (2 * k * count + bird.knots) / (2 * bird.knots); };
  return passed(knot) != passed(knot - 1);
}

// All Markov errors of one knot, in a fixed order.
template <typename Take>
void ForEachFeature(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
                    bool derivatives, int knot, const Take& take) {
  const double rate = 1 / model.knot_interval;
  const double time = (bird.first_knot + knot) * model.knot_interval;
  const double* c = &bird.path[3 * static_cast<std::size_t>(knot)];
  const CameraMotion camera = model.camera.At(time);

  const AccelerationError acceleration{
      .rate = rate, .reference_depth = bird.reference_depth, .camera = camera};
  const auto a = Evaluate<3, 3, 0>(
      derivatives, c, rate, std::array<double, 0>{}, std::array<int, 0>{},
      [&](const auto& q, const auto*, auto* error) { acceleration.Of(q, error); });
  for (int axis = 0; axis < 3; ++axis) {
    Feature feature = a[axis];
    feature.Subtract(model.turn, time, axis, shared);
    take(Term::kAcceleration, axis, feature);
  }

  const SpeedError speed{.rate = rate, .softening = bird.softening, .camera = camera};
  take(Term::kSpeed, 0,
       Evaluate<1, 2, 1>(
           derivatives, c, rate, std::array{bird.own[kOwnLogSpeed]},
           std::array<int, 1>{kOwnLogSpeed},
           [&](const auto& q, const auto* x, auto* error) { speed.Of(q, x[0], error); })[0]);

  if (model.use_climb && model.up_in_cam) {
    const LevelFlightError level{
        .rate = rate, .softening = bird.softening, .up_in_cam = *model.up_in_cam, .camera = camera};
    take(
        Term::kClimb, 0,
        Evaluate<1, 2, 0>(derivatives, c, rate, std::array<double, 0>{}, std::array<int, 0>{},
                          [&](const auto& q, const auto*, auto* error) { level.Of(q, error); })[0]);
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
                         .body_share = model.body.share};
    take(Term::kSize, 0,
         Evaluate<1, 2, 5>(
             derivatives, c, rate,
             std::array{bird.own[kOwnSizeBias], shared[kSizeRatio], shared[kLogTrunk],
                        shared[kLogUp], shared[kLean]},
             std::array<int, 5>{kOwnSizeBias, kOwnUnknowns + kSizeRatio, kOwnUnknowns + kLogTrunk,
                                kOwnUnknowns + kLogUp, kOwnUnknowns + kLean},
             [&](const auto& q, const auto* x, auto* error) {
               size.Of(q, x[0], x[1], x[2], x[3], x[4], error);
             })[0]);
  }
  if (model.use_depth && CountsForDepth(model, bird, knot)) {
    Feature depth;
    depth.value = (c[2] + 4 * c[5] + c[8]) / 6;
    depth.path[2] = depth.path[8] = 1.0 / 6;
    depth.path[5] = 4.0 / 6;
    depth.Subtract(model.depth, time, 0, shared);
    take(Term::kDepth, 0, depth);
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
                bool derivatives, const RowSink& take) {
  TakeReprojections(bird, derivatives, take);
  TakeViews(bird, take);
  const Spreads& s = model.spreads;
  const double dt = model.knot_interval;
  std::array<MarkovRows, 3> acceleration = {MarkovRows(Term::kAcceleration, s.acceleration, dt),
                                            MarkovRows(Term::kAcceleration, s.acceleration, dt),
                                            MarkovRows(Term::kAcceleration, s.acceleration, dt)};
  MarkovRows speed(Term::kSpeed, s.speed, dt), climb(Term::kClimb, s.climb, dt);
  MarkovRows size(Term::kSize, s.size, dt), depth(Term::kDepth, s.depth, dt);
  for (int knot = 0; knot < bird.knots; ++knot) {
    ForEachFeature(model, bird, shared, derivatives, knot,
                   [&](Term term, int axis, const Feature& feature) {
                     MarkovRows& rows = term == Term::kAcceleration ? acceleration[axis]
                                        : term == Term::kSpeed      ? speed
                                        : term == Term::kClimb      ? climb
                                        : term == Term::kSize       ? size
                                                                    : depth;
                     rows.Push(knot, feature, derivatives, take);
                   });
  }
  TakeAnchors(bird, take);
  TakeBounds(model, bird, take);
  TakeAnyVelocity(model, bird, take);
  TakeIndividual(model, bird, shared, take);
}

void ForEachError(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
                  const RowSink& take) {
  for (int knot = 0; knot < bird.knots; ++knot) {
    ForEachFeature(model, bird, shared, true, knot,
                   [&](Term term, int /*axis*/, const Feature& feature) {
                     ResidualRow row;
                     row.first = 3 * knot;
                     row.residual = feature.value;
                     std::copy(feature.path.begin(), feature.path.end(), row.path.begin());
                     for (int a = 0; a < feature.border_count; ++a) {
                       row.AddBorder(feature.border[a].first, feature.border[a].second);
                     }
                     take(term, row);
                   });
  }
}

double CostOf(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared) {
  double cost = 0;
  ForEachRow(model, bird, shared, false,
             [&](Term term, const ResidualRow& row) { cost += RobustCost(term, row.residual); });
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
