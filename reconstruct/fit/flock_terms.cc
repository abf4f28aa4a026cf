// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/flock_terms.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "reconstruct/fit/near_animals.h"
#include "reconstruct/fit/scene_terms.h"
#include "simulate/core/check.h"
#include "simulate/core/suggest.h"
#include "simulate/flock/model.h"
#include "simulate/forces/attraction.h"
#include "simulate/forces/linear.h"

namespace flocklift {
namespace {

// Which column a weight's term goes to and by how much: its own with the factor of a unit weight
// when it is free, otherwise "known" with its value.
struct Slot {
  std::size_t column = 0;
  double gain = 0;
};

Slot SlotOf(const std::vector<std::string>& free, const std::string& name, double unit,
            double value) {
  const auto found = std::find(free.begin(), free.end(), name);
  if (found == free.end()) return {free.size(), value};
  return {static_cast<std::size_t>(found - free.begin()), unit};
}

// v / |v|, by what a cruising speed does.
Vec3d OwnDirection(const Vec3d& x, const Vec3d& v) {
  return CruiseSpeed::At({1.0, 1.0}, x, v) - CruiseSpeed::At({1.0, 0.0}, x, v);
}

void NoTerms(std::span<const Vec3d> /*x*/, std::span<const Vec3d> /*v*/, std::span<Vec3d> out) {
  std::fill(out.begin(), out.end(), Vec3d{});
}

class BoidsTerms {
 public:
  BoidsTerms(const BoidsParameters<double>& given, const std::vector<std::string>& free,
             const std::optional<Region>& walls, const std::optional<GoalSpec>& goal,
             double cruising_speed)
      : parameters_(InSeconds(given)),
        columns_(free.size() + 2),
        walls_(walls),
        goal_(goal),
        cruising_speed_(cruising_speed) {
    BoidsParameters<double> ones = given;
    ones.alpha_s = ones.alpha_c = ones.alpha_a = ones.alpha_b = ones.cruise = ones.level = 1;
    const BoidsParameters<double> unit = InSeconds(ones);
    separation_ = SlotOf(free, "alpha_s", unit.alpha_s, parameters_.alpha_s);
    cohesion_ = SlotOf(free, "alpha_c", unit.alpha_c, parameters_.alpha_c);
    alignment_ = SlotOf(free, "alpha_a", unit.alpha_a, parameters_.alpha_a);
    boundary_ = SlotOf(free, "alpha_b", unit.alpha_b, parameters_.alpha_b);
    cruise_ = SlotOf(free, "cruise", unit.cruise, parameters_.cruise);
    level_ = SlotOf(free, "level", unit.level, parameters_.level);
    if (goal) attraction_ = SlotOf(free, kGoalWeight, 1, goal->weight);
  }

  void operator()(std::span<const Vec3d> x, std::span<const Vec3d> v, std::span<Vec3d> out) const {
    std::fill(out.begin(), out.end(), Vec3d{});
    AddPairs(x, v, out);
    for (std::size_t i = 0; i < x.size(); ++i) {
      Vec3d* const row = &out[i * columns_];
      if (walls_) {
        row[boundary_.column] += Boundary::At(
            {boundary_.gain, walls_->low, walls_->high, parameters_.wall_taper}, x[i], v[i]);
      }
      if (goal_) {
        row[attraction_.column] +=
            Attraction::At({attraction_.gain, goal_->position, parameters_.goal_range}, x[i], v[i]);
      }
      row[cruise_.column] += CruiseSpeed::At({cruise_.gain, cruising_speed_}, x[i], v[i]);
      row[level_.column] += Level::At({level_.gain}, x[i], v[i]);
      row[columns_ - 1] = OwnDirection(x[i], v[i]);
    }
  }

 private:
  void AddPairs(std::span<const Vec3d> x, std::span<const Vec3d> v, std::span<Vec3d> out) const {
    const double taper = parameters_.taper;
    if (parameters_.blind > 0) {
      const ViewCone<double> view{{}, SightCosine(parameters_.blind), parameters_.blind_taper};
      AddPairs(MakeBoidsPairs<double>(parameters_, taper, view), x, v, out);
    } else {
      AddPairs(MakeBoidsPairs<double>(parameters_, taper), x, v, out);
    }
  }
  template <typename Pairs>
  void AddPairs(const Pairs& pairs, std::span<const Vec3d> x, std::span<const Vec3d> v,
                std::span<Vec3d> out) const {
    internal::ForEachAnimal(
        x, v, Reach(parameters_), [&](std::uint32_t animal, const auto& others) {
          typename Pairs::Sums sums;
          const Vec3d& own_velocity = v[animal];
          const auto own = pairs.For(own_velocity);
          others([&](std::uint32_t /*other*/, const Vec3d& dx, const Vec3d& velocity) {
            sums += own.Pair(dx, velocity - own_velocity);
          });
          Vec3d* const to = &out[animal * columns_];
          auto p = pairs;
          p.separation.gain = separation_.gain;
          p.cohesion.gain = cohesion_.gain;
          p.alignment.gain = alignment_.gain;
          to[separation_.column] += Separation::Finish(p.separation, sums.separation);
          to[cohesion_.column] += Cohesion::Finish(p.cohesion, sums.cohesion);
          to[alignment_.column] += Alignment::Finish(p.alignment, sums.alignment);
        });
  }

  BoidsParameters<double> parameters_;  // in seconds
  std::size_t columns_;
  std::optional<Region> walls_;
  std::optional<GoalSpec> goal_;
  double cruising_speed_;  // [m/s]
  Slot separation_, cohesion_, alignment_, boundary_, cruise_, level_, attraction_;
};

class LinearTerms {
 public:
  LinearTerms(const LinearParameters<double>& given, const std::vector<std::string>& free)
      : columns_(free.size() + 2),
        cohesion_(SlotOf(free, "cohesion", 1, given.cohesion)),
        alignment_(SlotOf(free, "alignment", 1, given.alignment)) {}

  void operator()(std::span<const Vec3d> x, std::span<const Vec3d> v, std::span<Vec3d> out) const {
    std::fill(out.begin(), out.end(), Vec3d{});
    const LinearCohesion::Params<double> cohesion{cohesion_.gain};
    const LinearAlignment::Params<double> alignment{alignment_.gain};
    for (std::size_t i = 0; i < x.size(); ++i) {
      Weighted<double> offsets, differences;
      for (std::size_t j = 0; j < x.size(); ++j) {
        if (j == i) continue;
        offsets += LinearCohesion::Pair(cohesion, x[j] - x[i], v[j] - v[i]);
        differences += LinearAlignment::Pair(alignment, x[j] - x[i], v[j] - v[i]);
      }
      out[i * columns_ + cohesion_.column] += LinearCohesion::Finish(cohesion, offsets);
      out[i * columns_ + alignment_.column] += LinearAlignment::Finish(alignment, differences);
    }
  }

 private:
  std::size_t columns_;
  Slot cohesion_, alignment_;
};

template <typename Parameters>
std::vector<std::string> WeightsOf(const Parameters&) {
  return {};  // none by which its accelerations are linear
}
std::vector<std::string> WeightsOf(const BoidsParameters<double>&) {
  return {"alpha_s", "alpha_c", "alpha_a", "alpha_b", "cruise", "level"};
}
std::vector<std::string> WeightsOf(const LinearParameters<double>&) {
  return {"cohesion", "alignment"};
}

}  // namespace

std::vector<std::string> LinearWeights(const ModelSpec& model) {
  const ModelParameters resolved = ResolveModel(model);
  std::vector<std::string> weights =
      std::visit([](const auto& p) { return WeightsOf(p); }, resolved);
  if (weights.empty() && !std::holds_alternative<ForcesParameters>(resolved)) return weights;
  for (std::string& weight : TermWeights(model)) weights.push_back(std::move(weight));
  return weights;
}

FlockTerms MakeFlockTerms(const ModelSpec& model, const std::vector<std::string>& free,
                          const std::optional<Region>& walls, const std::optional<GoalSpec>& goal,
                          double cruising_speed, const TermSurroundings& around) {
  const ModelParameters resolved = ResolveModel(model);
  std::vector<std::string> weights = LinearWeights(model);
  if (goal) weights.push_back(kGoalWeight);
  for (const std::string& name : free) {
    if (std::find(weights.begin(), weights.end(), name) != weights.end()) continue;
    throw InputError("--free", 0, "`" + name + "` of model " + model.name + " cannot be freed",
                     SuggestName(name, weights));
  }
  FlockTerms terms;
  terms.free = free;
  if (const auto* boids = std::get_if<BoidsParameters<double>>(&resolved)) {
    if (boids->nearest > 0) {
      throw InputError(model.WhereOf("nearest"), 0, "a fit knows no topological neighbours",
                       "take nearest = 0, and a d_v");
    }
    const BoidsParameters<double> seconds = InSeconds(*boids);
    terms.has_own_speed =
        boids->cruise > 0 || std::find(free.begin(), free.end(), "cruise") != free.end();
    terms.min_speed = seconds.s_min;
    terms.max_speed = seconds.s_max;
    terms.evaluate = BoidsTerms(*boids, free, walls, goal, cruising_speed);
  } else if (const auto* linear = std::get_if<LinearParameters<double>>(&resolved)) {
    terms.evaluate = LinearTerms(*linear, free);
  } else if (const auto* forces = std::get_if<ForcesParameters>(&resolved)) {
    terms.min_speed = forces->s_min;
    terms.max_speed = forces->s_max;
    terms.evaluate = NoTerms;
  } else {
    throw InputError(model.where, 0, "model " + model.name + " has no terms that a fit could weigh",
                     "take boids, boids2d, linear or forces");
  }
  const SceneTerms added(model, free, around);
  if (added.empty()) return terms;
  const std::size_t columns = terms.columns();
  const bool alone = std::holds_alternative<ForcesParameters>(resolved);
  const auto is_cruise = [&](const ModelSpec& term) { return term.name == "cruise"; };
  const bool cruises = std::any_of(model.terms.begin(), model.terms.end(), is_cruise);
  terms.has_own_speed = terms.has_own_speed || cruises;
  terms.evaluate = [own = terms.evaluate, added, columns, cruising_speed,
                    direction = alone && cruises](std::span<const Vec3d> x,
                                                  std::span<const Vec3d> v, std::span<Vec3d> out) {
    own(x, v, out);
    added.AddColumns(cruising_speed, x, v, out);
    for (std::size_t i = 0; direction && i < x.size(); ++i) {
      out[(i + 1) * columns - 1] = OwnDirection(x[i], v[i]);
    }
  };
  return terms;
}

}  // namespace flocklift
