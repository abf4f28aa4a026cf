// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/force_types.h"

namespace flocklift {
namespace {

const Registry<ForceParameters>& Known() {
  const std::string ucsd = "UCSD CSE 167, assignment 5";
  static const Registry<ForceParameters> registry(
      "force",
      {{"separation", "away from the mean offset of near neighbours", ucsd, SeparationForce{}},
       {"cohesion", "to the mean position of neighbours", ucsd, CohesionForce{}},
       {"alignment", "to the mean velocity of neighbours", ucsd, AlignmentForce{}},
       {"repulsion", "away from neighbours, weighted by a power of distance", "Lin 2019",
        RepulsionForce{}},
       {"goal", "the pull of the scene's goals", "Xu et al. 2008", GoalForce{}},
       {"walls", "the push of the scene's box", ucsd, WallForce{}},
       {"cruise", "back to the own cruising speed", "", CruiseForce{}},
       {"level", "against climbing and sinking", "", LevelForce{}},
       {"flee", "away from the scene's predators", ucsd, FleeForce{}},
       {"wind", "along with the scene's wind", "", WindForce{}},
       {"drag", "against the own velocity", "Chen et al. 2019", DragForce{}},
       {"gravity", "downwards", "Wang et al. 2014 (morphing)", GravityForce{}},
       {"noise", "random acceleration, correlated in time", "", NoiseForce{}},
       {"curl", "curl noise: a field without sources", "Chen et al. 2019", CurlForce{}},
       {"perlin", "Perlin noise, the baseline of curl noise", "Wang et al. 2014", PerlinForce{}}});
  return registry;
}

}  // namespace

const std::vector<ModelInfo>& ForceTypes() { return Known().infos(); }
ForceParameters ResolveForce(const ModelSpec& spec) { return Known().Resolve(spec); }
ModelSpec CompleteForce(const ModelSpec& spec) { return Known().Complete(spec); }

}  // namespace flocklift
