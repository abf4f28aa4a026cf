// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/model.h"

#include "simulate/core/model_terms.h"
#include "simulate/flock/force_types.h"

namespace flocklift {
namespace {

const Registry<ModelParameters>& Known() {
  static const Registry<ModelParameters> registry(
      "model",
      {{"boids", "separation, cohesion, alignment and walls; birds at about 10 m/s, in metres",
        "UCSD CSE 167, assignment 5 (after Reynolds 1987)", BoidsParameters<double>{}},
       {"boids2d", "the same with the assignment's own numbers: pixels, and steps of 1/30 s",
        "UCSD CSE 167, assignment 5", AssignmentParameters()},
       {"lin", "separation, cohesion over all, homing; position-based", "Lin 2019",
        LinParameters<double>{}},
       {"linear", "springs and drag between all pairs, for checking estimators",
        "equations.md, section 2b", LinearParameters<double>{}},
       {"opensteer", "steering forces of unit length, each with its own radius and view",
        "OpenSteer (Reynolds 1999)", OpenSteerParameters{}},
       {"bswarm", "three zones, self-propulsion, curl noise; collision-free by velocity obstacles",
        "Wang et al. 2015, Ren et al. 2016, Chen et al. 2019", BSwarmParameters{}},
       {"forces", "nothing but the terms that stand below [[species.force]]", "the scene",
        ForcesParameters{}},
       {"swarm", "curl noise and the cheapest way to the goals, without inertia; insects",
        "Wang, Jin, Deng, Zhou 2014", SwarmParameters{}},
       {"shape", "insects that form a [[shape]], stay in motion on it, and follow it along a path",
        "Chen, Luo, Tong, Jin, Deng 2019", ShapeParameters{}},
       {"morph", "tetrahedra fly from the start shape along the path and become the shape",
        "Wang, Zhou, Deng, Jin 2014", MorphParameters{}},
       {"crowd", "groups that walk to goals of their own, round others and along with the flow",
        "Treuille, Cooper, Popovic 2006", CrowdParameters{}}});
  return registry;
}

}  // namespace

const std::vector<ModelInfo>& Models() { return Known().infos(); }
const ModelInfo* FindModel(std::string_view name) { return Known().Find(name); }
ModelParameters ResolveModel(const ModelSpec& spec) { return Known().Resolve(spec); }
ModelSpec CompleteModel(const ModelSpec& spec) {
  ModelSpec complete = Known().Complete(spec);
  for (ModelSpec& term : complete.terms) term = CompleteForce(term);
  return complete;
}

const ParameterInfo* FindParameter(const ModelSpec& model, const std::string& name) {
  const auto [term, own] = SplitName(model, name);
  const std::vector<ModelInfo>& infos = term == nullptr ? Models() : ForceTypes();
  const std::string& of = term == nullptr ? model.name : term->name;
  for (const ModelInfo& info : infos) {
    if (info.name != of) continue;
    for (const ParameterInfo& parameter : info.parameters) {
      if (parameter.name == own) return &parameter;
    }
  }
  return nullptr;
}

}  // namespace flocklift
