// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/read_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "reconstruct/cost_functions/path.h"

namespace flocklift::internal {
namespace {

SolvedPoint PointAt(const BatchModel& model, const Bird& bird, const Bird::Place& place) {
  const double rate = 1 / model.knot_interval;
  const double* c = &bird.path[3 * static_cast<std::size_t>(place.interval)];
  PathState<double> q{};
  const double s = place.weights[3] > 0 ? std::cbrt(6 * place.weights[3]) : 0;
  const std::array<double, 4> curves = SplineCurves(s);
  const CameraMotion camera =
      model.camera.At((bird.first_knot + place.interval + s) * model.knot_interval);
  for (std::size_t a = 0; a < 4; ++a, c += 3) {
    const double curve = curves[a] * rate * rate;
    q.x += place.weights[a] * c[0];
    q.y += place.weights[a] * c[1];
    q.l += place.weights[a] * c[2];
    q.dx += place.slopes[a] * c[0];
    q.dy += place.slopes[a] * c[1];
    q.dl += place.slopes[a] * c[2];
    q.ddx += curve * c[0];
    q.ddy += curve * c[1];
    q.ddl += curve * c[2];
  }
  const double z = std::exp(q.l);
  return {.position_in_cam = {z * q.x, z * q.y, z},
          .velocity_in_cam = z * VelocityOverDepth(q, camera),
          .acceleration_in_cam = z * AccelerationOverDepth(q, camera)};
}

}  // namespace

Eigen::MatrixXd ReadOut(BatchState* state, BatchSolver* solver, BatchResult* result) {
  Eigen::MatrixXd covariance = solver->Linearize();
  result->paths.resize(state->birds.size());
  double rows = 0;
  for (const Bird& bird : state->birds) rows += static_cast<double>(bird.places.size());
  std::vector<std::pair<double, Eigen::VectorXd>> means(state->birds.size());
  solver->ForEachBird([&](std::size_t i) {
    const Bird& bird = state->birds[i];
    const ArrowSystem& system = solver->work(i).system;
    const ArrowSystem::Posterior posterior = system.Covariance(covariance);
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(bird.unknowns());
    for (const Bird::Place& place : bird.places) {
      SolvedPoint point = PointAt(state->model, bird, place);
      ResidualRow row;
      row.first = 3 * place.interval;
      for (int a = 0; a < 4; ++a) {
        row.path[3 * a + 2] = place.weights[a];
        weights[row.first + 3 * a + 2] += place.weights[a] / rows;
      }
      const double variance = system.VarianceOf(posterior, row);
      point.sd_log_depth = std::isfinite(variance) && variance > 0 ? std::sqrt(variance) : 1;
      result->paths[i].push_back(point);
    }
    means[i] = system.Functional(weights);
  });
  double variance = 0;
  Eigen::VectorXd sensitivity = Eigen::VectorXd::Zero(state->model.shared());
  for (const auto& [own, shared] : means) {
    variance += own;
    sensitivity += shared;
  }
  variance += sensitivity.dot(covariance * sensitivity);
  BatchReport& report = result->report;
  report.scale_sd = std::sqrt(std::max(variance, 0.0));
  const double speed = std::exp(state->shared[kFlockLogSpeed]);
  report.flock_speed = {speed, speed * std::sqrt(covariance(kFlockLogSpeed, kFlockLogSpeed))};
  const double ratio = std::exp(state->shared[kSizeRatio] - state->model.size_ratio.mean);
  const BatchModel& model = state->model;
  report.speed_against_size = {(state->shared[kFlockLogSpeed] - model.flock_log_speed.mean) +
                                   (model.size_ratio.mean - state->shared[kSizeRatio]),
                               model.size_ratio.sd};
  report.size_ratio = {ratio, ratio * std::sqrt(covariance(kSizeRatio, kSizeRatio))};
  report.lean = {state->shared[kLean], std::sqrt(covariance(kLean, kLean))};
  return covariance;
}

void CollectTerms(const BatchState& state, BatchReport* report) {
  std::array<double, kTermCount> squares{}, outliers{};
  std::array<long, kTermCount> counts{};
  for (const Bird& bird : state.birds) {
    ForEachRow(state.model, bird, state.shared, false, [&](Term term, const ResidualRow& row) {
      const std::size_t k = static_cast<std::size_t>(term);
      squares[k] += row.residual * row.residual;
      outliers[k] += std::abs(row.residual) > 3 ? 1 : 0;
      ++counts[k];
    });
  }
  for (std::size_t k = 0; k < kTermCount; ++k) {
    if (counts[k] == 0) continue;
    const double n = static_cast<double>(counts[k]);
    report->terms.push_back(
        {NameOf(static_cast<Term>(k)), counts[k], std::sqrt(squares[k] / n), outliers[k] / n});
  }
  const Spreads& s = state.model.spreads;
  report->spreads = {
      {"acceleration [m/s^2]", s.acceleration.sd},
      {"speed between animals", s.speed_between},
      {state.model.erratic ? "log speed across the line of sight" : "speed over time", s.speed.sd},
      {"size between animals", s.size_between},
      {"size over time", s.size.sd},
      {"sine of climb", s.climb.sd},
      {"log depth", s.depth.sd}};
  if (state.model.turn.knots > 0) {
    report->spreads.push_back({"common acceleration [m/s^2]", s.turn.sd});
  }
}

}  // namespace flocklift::internal
