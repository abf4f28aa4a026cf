// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Models by name: what there is, with units, ranges and defaults, and the checked way from what a
// file says (ModelSpec) to the numbers.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MODEL_H_

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "simulate/core/options.h"
#include "simulate/core/scene.h"
#include "simulate/flock/boids.h"
#include "simulate/flock/lin_model.h"
#include "simulate/flock/linear_model.h"

namespace flocklift {

struct ParameterInfo {
  std::string name;
  double value = 0;  // default
  Range range;
  std::string unit, help;
};

struct ModelInfo {
  std::string name, help, source;
  std::vector<ParameterInfo> parameters;  // in the order of the model's Describe
};

// All models, and one by name (null when there is none of that name).
const std::vector<ModelInfo>& Models();
const ModelInfo* FindModel(std::string_view name);

using ModelParameters =
    std::variant<BoidsParameters<double>, LinParameters<double>, LinearParameters<double>>;

// The numbers of a model, defaults where the spec says nothing. InputError, told from the spec's
// place in its file, when there is no such model or parameter (the nearest name is suggested) or a
// number is out of its range.
ModelParameters ResolveModel(const ModelSpec& spec);

// The spec with every parameter of the model spelled out; checks as ResolveModel does.
ModelSpec CompleteModel(const ModelSpec& spec);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MODEL_H_
