// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/process_model.h"

#include <algorithm>
#include <optional>

#include "simulate/core/check.h"
#include "simulate/core/suggest.h"
#include "simulate/flock/model.h"
#include "simulate/forces/linear.h"

namespace flocklift {
namespace {

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

std::vector<std::string> SmoothParameters(const std::string& model) {
  if (model == "linear") return {"cohesion", "alignment"};
  return {};
}

}  // namespace

bool IsSmooth(const ModelSpec& model) { return !SmoothParameters(model.name).empty(); }

ProcessModel MakeProcessModel(const ModelSpec& model, const std::vector<std::string>& free) {
  const ModelParameters resolved = ResolveModel(model);
  const std::vector<std::string> names = SmoothParameters(model.name);
  if (names.empty()) {
    throw InputError(model.where, 0,
                     "model " + model.name + " is not smooth enough for a state-space fit",
                     "take --method errors-in-variables");
  }
  const ModelSpec complete = CompleteModel(model);
  ProcessModel process;
  process.free = free;
  for (const std::string& name : free) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw InputError(model.where, 0, "`" + name + "` of model " + model.name + " cannot be freed",
                       SuggestName(name, names));
    }
    process.start.push_back(complete.parameters.at(name));
  }
  process.evaluate = LinearProcess(std::get<LinearParameters<double>>(resolved), free);
  return process;
}

}  // namespace flocklift
