// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Models by name: what there is, with units, ranges and defaults, and the checked way from what a
// file says (ModelSpec) to the numbers.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MODEL_H_

#include <string_view>
#include <variant>
#include <vector>

#include "simulate/core/scene.h"
#include "simulate/flock/boids.h"
#include "simulate/flock/bswarm_model.h"
#include "simulate/flock/crowd_model.h"
#include "simulate/flock/forces_model.h"
#include "simulate/flock/lin_model.h"
#include "simulate/flock/linear_model.h"
#include "simulate/flock/morph_model.h"
#include "simulate/flock/opensteer_model.h"
#include "simulate/flock/registry.h"
#include "simulate/flock/shape_model.h"
#include "simulate/flock/swarm_model.h"

namespace flocklift {

// All models, and one by name (null when there is none of that name).
const std::vector<ModelInfo>& Models();
const ModelInfo* FindModel(std::string_view name);

using ModelParameters =
    std::variant<BoidsParameters<double>, LinParameters<double>, LinearParameters<double>,
                 ForcesParameters, OpenSteerParameters, BSwarmParameters, SwarmParameters,
                 ShapeParameters, MorphParameters, CrowdParameters>;

// Registry::Resolve and Registry::Complete of the models; the latter of the terms that add to one,
// too.
ModelParameters ResolveModel(const ModelSpec& spec);
ModelSpec CompleteModel(const ModelSpec& spec);

// Of the model's own parameters or its terms' (simulate/core/model_terms.h); null where there is
// none of that name.
const ParameterInfo* FindParameter(const ModelSpec& model, const std::string& name);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MODEL_H_
