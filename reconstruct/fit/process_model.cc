// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/process_model.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "reconstruct/fit/boids_process.h"
#include "reconstruct/fit/scene_terms.h"
#include "simulate/core/check.h"
#include "simulate/core/model_terms.h"
#include "simulate/core/suggest.h"
#include "simulate/flock/model.h"
#include "simulate/forces/linear.h"

namespace flocklift {
namespace {

constexpr int kRmsFrames = 50;  // looked at for the rms of a parameter

// A value that is given, or one of theta.
struct Source {
  std::optional<std::size_t> index;
  double value = 0;

  double In(std::span<const double> theta) const { return index ? theta[*index] : value; }
};

Source SourceOf(const std::vector<std::string>& free, const std::string& name, double value) {
  const auto found = std::find(free.begin(), free.end(), name);
  if (found == free.end()) return {.index = {}, .value = value};
  return {.index = static_cast<std::size_t>(found - free.begin()), .value = value};
}

std::array<double, 9> Isotropic(double value) { return {value, 0, 0, 0, value, 0, 0, 0, value}; }

void Nothing(std::span<const double> /*theta*/, std::span<const Vec3d> /*x*/,
             std::span<const Vec3d> /*v*/, std::span<Vec3d> a, std::span<OwnSlope> slopes) {
  std::fill(a.begin(), a.end(), Vec3d{});
  std::fill(slopes.begin(), slopes.end(), OwnSlope{});
}

class LinearProcess {
 public:
  LinearProcess(const LinearParameters<double>& given, const std::vector<std::string>& free)
      : cohesion_(SourceOf(free, "cohesion", given.cohesion)),
        alignment_(SourceOf(free, "alignment", given.alignment)) {}

  void operator()(std::span<const double> theta, std::span<const Vec3d> x, std::span<const Vec3d> v,
                  std::span<Vec3d> a, std::span<OwnSlope> slopes) const {
    const LinearCohesion::Params<double> cohesion{cohesion_.In(theta)};
    const LinearAlignment::Params<double> alignment{alignment_.In(theta)};
    const auto n = static_cast<double>(x.size());
    Vec3d x_sum, v_sum;
    for (const Vec3d& position : x) x_sum += position;
    for (const Vec3d& velocity : v) v_sum += velocity;
    for (std::size_t i = 0; i < x.size(); ++i) {
      a[i] = LinearCohesion::Finish(cohesion, {x_sum - n * x[i], n - 1}) +
             LinearAlignment::Finish(alignment, {v_sum - n * v[i], n - 1});
    }
    const OwnSlope slope{Isotropic((1 - n) * cohesion.gain), Isotropic((1 - n) * alignment.gain)};
    std::fill(slopes.begin(), slopes.end(), slope);
  }

 private:
  Source cohesion_, alignment_;
};

}  // namespace

std::vector<std::string> SmoothParameters(const ModelSpec& model) {
  const ModelParameters resolved = ResolveModel(model);
  if (std::holds_alternative<LinearParameters<double>>(resolved)) return {"cohesion", "alignment"};
  std::vector<std::string> names;
  if (const auto* boids = std::get_if<BoidsParameters<double>>(&resolved)) {
    names = SmoothBoidsParameters(*boids);
  } else if (std::holds_alternative<ForcesParameters>(resolved)) {
    names = {"s_min", "s_max"};
  }
  const auto added = SmoothTermParameters(model);
  if (names.empty() || !added || !UnknownTerm(model).empty()) return {};
  names.insert(names.end(), added->begin(), added->end());
  return names;
}

ProcessModel MakeProcessModel(const ModelSpec& model, const std::vector<std::string>& free,
                              const std::optional<Region>& walls, const TermSurroundings& around) {
  const ModelParameters resolved = ResolveModel(model);
  const std::vector<std::string> names = SmoothParameters(model);
  if (names.empty()) {
    throw InputError(model.where, 0,
                     "model " + model.name + " is not smooth enough for a state-space fit",
                     "take --method errors-in-variables, or for boids --set a taper above 0, "
                     "noise_time = 0 and cruise = 0, and likewise of a scene's terms");
  }
  const ModelSpec complete = CompleteModel(model);
  ProcessModel process;
  process.free = free;
  for (const std::string& name : free) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw InputError("--free", 0, "`" + name + "` of model " + model.name + " cannot be freed",
                       SuggestName(name, names));
    }
    process.start.push_back(*FindNumber(complete, name));
  }
  if (const auto* boids = std::get_if<BoidsParameters<double>>(&resolved)) {
    SetBoidsProcess(*boids, walls, &process);
  } else if (const auto* forces = std::get_if<ForcesParameters>(&resolved)) {
    process.evaluate = Nothing;
    process.speed_range =
        [low = SourceOf(free, "s_min", forces->s_min),
         high = SourceOf(free, "s_max", forces->s_max)](std::span<const double> theta) {
          return SpeedRange{std::max(0.0, low.In(theta)), std::max(0.0, high.In(theta))};
        };
  } else {
    process.evaluate = LinearProcess(std::get<LinearParameters<double>>(resolved), free);
  }
  const SceneTerms added(model, free, around);
  if (added.empty()) return process;
  process.evaluate = [own = process.evaluate, added](
                         std::span<const double> theta, std::span<const Vec3d> x,
                         std::span<const Vec3d> v, std::span<Vec3d> a, std::span<OwnSlope> slopes) {
    own(theta, x, v, a, slopes);
    added.AddAccelerations(theta, x, v, a, slopes);
  };
  return process;
}

std::vector<double> ParameterRms(const ProcessModel& model, const std::vector<double>& theta,
                                 const std::vector<double>& sd, const ObservedFlock& flock,
                                 int substeps) {
  std::vector<double> squares(theta.size());
  double count = 0;
  const FrameSpan span = flock.span();
  const int stride = std::max(1, (span.last - span.first) / kRmsFrames);
  for (int f = span.first; f <= span.last; f += stride) {
    const ObservedFlock::State state = flock.Between(f, 0, 1, substeps > 0 ? 1.0 / substeps : 0);
    std::vector<Vec3d> low(state.position.size()), high(state.position.size());
    for (std::size_t p = 0; p < theta.size(); ++p) {
      const double size = std::max(std::abs(theta[p]), 1e-3);
      const double half = std::isfinite(sd[p]) ? std::min(0.1 * sd[p], 1e-3 * size) : 1e-3 * size;
      std::vector<double> moved = theta;
      moved[p] = theta[p] - half;
      model.evaluate(moved, state.position, state.velocity, low, {});
      moved[p] = theta[p] + half;
      model.evaluate(moved, state.position, state.velocity, high, {});
      for (std::size_t i = 0; i < low.size(); ++i) {
        squares[p] += SquaredNorm(high[i] - low[i]) / (12 * half * half);
      }
    }
    count += static_cast<double>(low.size());
  }
  for (double& square : squares) square = std::sqrt(square / std::max(count, 1.0));
  return squares;
}

}  // namespace flocklift
