// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/scene_terms.h"

#include <ceres/jet.h>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

#include "reconstruct/fit/near_animals.h"
#include "reconstruct/fit/term_at.h"
#include "simulate/core/model_terms.h"

namespace flocklift {
namespace {

using Jet = ceres::Jet<double, 6>;  // by the animal's own position and velocity
using internal::TermAt;

// The parameter by which a term is linear, null where it has none.
template <typename Params>
double* WeightIn(Params& p) {
  if constexpr (std::is_base_of_v<NeighbourForce, Params> || std::is_same_v<Params, WallForce>) {
    return &p.gain;
  } else if constexpr (std::is_same_v<Params, GravityForce>) {
    return &p.g;
  } else if constexpr (requires { p.rate; }) {
    return &p.rate;
  } else {
    return nullptr;
  }
}

// The name of the field at `wanted`.
struct NameOfField {
  const double* wanted;
  std::string name;

  void operator()(std::string_view field, const double& value, Range, std::string_view,
                  std::string_view) {
    if (&value == wanted) name = field;
  }
};

std::string WeightName(ForceParameters p) {
  return std::visit(
      [](auto& term) {
        NameOfField find{WeightIn(term), {}};
        Describe(find, term);
        return find.name;
      },
      p);
}

// Sets the fields that theta names; what is no weight stays in its range.
struct Assign {
  const std::string& term;
  const std::vector<std::string>& free;
  std::span<const double> theta;
  const double* weight;

  void operator()(std::string_view name, double& value, Range range, std::string_view /*unit*/,
                  std::string_view /*help*/) const {
    const auto found = std::find(free.begin(), free.end(), term + "." + std::string(name));
    if (found == free.end()) return;
    value = theta[static_cast<std::size_t>(found - free.begin())];
    if (&value != weight) value = std::clamp(value, range.low, range.high);
  }
};

double ReachOf(const ForceParameters& parameters) {
  return std::visit(
      [](const auto& p) -> double {
        if constexpr (std::is_base_of_v<NeighbourForce, std::decay_t<decltype(p)>>) {
          return p.radius + 0.5 * p.taper;
        } else {
          return 0;
        }
      },
      parameters);
}

// Of each animal the others within reach, ascending.
std::vector<std::vector<std::uint32_t>> Near(std::span<const Vec3d> x, std::span<const Vec3d> v,
                                             double reach) {
  std::vector<std::vector<std::uint32_t>> near(x.size());
  if (!(reach > 0)) return near;
  internal::ForEachAnimal(x, v, reach, [&](std::uint32_t animal, const auto& others) {
    std::vector<std::uint32_t>& of = near[animal];
    others([&](std::uint32_t other, const Vec3d& /*dx*/, const Vec3d& /*velocity*/) {
      of.push_back(other);
    });
    std::sort(of.begin(), of.end());
  });
  return near;
}

// Of the parameters that can be freed; nothing where the term is not smooth.
template <typename Params>
bool IsSmooth(const Params& p) {
  if constexpr (requires { p.taper; }) {
    return p.taper > 0;
  } else if constexpr (std::is_same_v<Params, NoiseForce>) {
    return p.time == 0 || p.sd == 0;
  } else if constexpr (std::is_same_v<Params, CruiseForce>) {
    return p.rate == 0;
  } else {
    return !std::is_same_v<Params, FleeForce> && !std::is_base_of_v<FieldNoiseForce, Params>;
  }
}

}  // namespace

std::vector<std::string> TermWeights(const ModelSpec& model) {
  std::vector<std::string> weights;
  const std::vector<std::string> names = TermNames(model.terms);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string weight = WeightName(ResolveForce(model.terms[k]));
    if (!weight.empty()) weights.push_back(names[k] + "." + weight);
  }
  return weights;
}

std::optional<std::vector<std::string>> SmoothTermParameters(const ModelSpec& model) {
  std::vector<std::string> free;
  const std::vector<std::string> names = TermNames(model.terms);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const ForceParameters parameters = ResolveForce(model.terms[k]);
    if (!std::visit([](const auto& p) { return IsSmooth(p); }, parameters)) return std::nullopt;
    if (std::holds_alternative<NoiseForce>(parameters)) continue;  // what is left over
    if (std::holds_alternative<CruiseForce>(parameters)) continue;
    for (const auto& [name, value] : CompleteForce(model.terms[k]).parameters) {
      free.push_back(names[k] + "." + name);
    }
  }
  return free;
}

std::string UnknownTerm(const ModelSpec& model) {
  for (const ModelSpec& term : model.terms) {
    if (term.name == "flee") return "it flees from predators, which trajectories do not hold";
    if (term.name == "curl" || term.name == "perlin") {
      return "the field of its " + term.name + " noise is not known";
    }
  }
  return "";
}

double CruiseRateOfTerms(const ModelSpec& model) {
  double rate = 0;
  for (const ModelSpec& term : model.terms) {
    const ForceParameters parameters = ResolveForce(term);
    if (const auto* cruise = std::get_if<CruiseForce>(&parameters)) rate += cruise->rate;
  }
  return rate;
}

SceneTerms::SceneTerms(const ModelSpec& model, std::vector<std::string> free,
                       TermSurroundings around)
    : free_(std::move(free)), around_(std::move(around)) {
  const std::vector<std::string> names = TermNames(model.terms);
  for (std::size_t k = 0; k < names.size(); ++k) {
    Term term;
    term.name = names[k];
    term.given = term.unit = ResolveForce(model.terms[k]);
    term.column = free_.size();
    std::visit(
        [&](auto& p) {
          double* const weight = WeightIn(p);
          if (weight == nullptr) return;
          term.weight = std::exchange(*weight, 1);
        },
        term.unit);
    const std::string name = term.name + "." + WeightName(term.unit);
    const auto found = std::find(free_.begin(), free_.end(), name);
    if (found != free_.end()) {
      term.column = static_cast<std::size_t>(found - free_.begin());
      term.weight = 1;
    }
    terms_.push_back(std::move(term));
  }
}

void SceneTerms::AddColumns(double cruising_speed, std::span<const Vec3d> x,
                            std::span<const Vec3d> v, std::span<Vec3d> out) const {
  if (terms_.empty()) return;
  double reach = 0;
  for (const Term& term : terms_) reach = std::max(reach, ReachOf(term.unit));
  const auto near = Near(x, v, reach);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const TermAt<double> at{around_, x, v, near[i], x[i], v[i], cruising_speed};
    for (const Term& term : terms_) {
      Vec3d a = term.weight * std::visit(at, term.unit);
      if (around_.flat) a.z = 0;
      out[i * (free_.size() + 2) + term.column] += a;
    }
  }
}

void SceneTerms::AddAccelerations(std::span<const double> theta, std::span<const Vec3d> x,
                                  std::span<const Vec3d> v, std::span<Vec3d> a,
                                  std::span<OwnSlope> slopes) const {
  if (terms_.empty()) return;
  std::vector<ForceParameters> parameters;
  double reach = 0;
  for (const Term& term : terms_) {
    parameters.push_back(term.given);
    std::visit(
        [&](auto& p) {
          Assign assign{term.name, free_, theta, WeightIn(p)};
          Describe(assign, p);
        },
        parameters.back());
    reach = std::max(reach, ReachOf(parameters.back()));
  }
  const auto near = Near(x, v, reach);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (slopes.empty()) {
      const TermAt<double> at{around_, x, v, near[i], x[i], v[i], 0};
      for (const ForceParameters& term : parameters) a[i] += std::visit(at, term);
      if (around_.flat) a[i].z = 0;
      continue;
    }
    const TermAt<Jet> at{around_,
                         x,
                         v,
                         near[i],
                         {{x[i].x, 0}, {x[i].y, 1}, {x[i].z, 2}},
                         {{v[i].x, 3}, {v[i].y, 4}, {v[i].z, 5}},
                         0};
    Vec3<Jet> sum = TermAt<Jet>::Nothing();
    for (const ForceParameters& term : parameters) sum += std::visit(at, term);
    if (around_.flat) sum.z = Jet(0.0);
    a[i] += {sum.x.a, sum.y.a, sum.z.a};
    const Jet* const axes[] = {&sum.x, &sum.y, &sum.z};
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        const auto k = static_cast<Eigen::Index>(column);
        slopes[i].position[3 * row + column] += axes[row]->v[k];
        slopes[i].velocity[3 * row + column] += axes[row]->v[k + 3];
      }
    }
  }
}

}  // namespace flocklift
