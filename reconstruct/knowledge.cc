// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/knowledge.h"

#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

void CheckPositive(const std::optional<Uncertain>& number, const std::string& name) {
  if (!number) return;
  Check(number->mean > 0 && std::isfinite(number->mean), name + " must be a positive number");
  Check(number->sd > 0 && std::isfinite(number->sd),
        "the standard deviation of " + name + " must be a positive number");
}

}  // namespace

bool FixesScale(const Knowledge& k) {
  return k.speed || (k.wingspan && k.use_size) || (k.near && k.far) || !k.anchors.empty() ||
         k.second_camera;
}

void CheckKnowledge(const Knowledge& knowledge) {
  CheckPositive(knowledge.speed, "speed");
  CheckPositive(knowledge.wingspan, "wingspan");
  Check(!knowledge.near || (*knowledge.near > 0 && std::isfinite(*knowledge.near)),
        "near must be a positive distance");
  Check(!knowledge.far || (*knowledge.far > 0 && std::isfinite(*knowledge.far)),
        "far must be a positive distance");
  if (knowledge.near && knowledge.far) {
    Check(*knowledge.near < *knowledge.far, "near must be less than far");
  }
  Check(FixesScale(knowledge),
        "a single camera does not see absolute scale (a flock twice as far, twice as large and "
        "twice as fast looks the same): give at least one of --speed, --wingspan (with sizes in "
        "use), --near with --far, --anchors, or the tracks of a second camera");
}

std::string ScaleSources(const Knowledge& knowledge) {
  std::string names;
  const auto add = [&names](bool known, const std::string& name) {
    if (known) names += (names.empty() ? "" : ", ") + name;
  };
  add(knowledge.speed.has_value(), "speed");
  add(knowledge.wingspan && knowledge.use_size, "wingspan");
  add(knowledge.near && knowledge.far, "near/far");
  add(!knowledge.anchors.empty(), "anchors");
  add(knowledge.second_camera, "second camera");
  return names;
}

}  // namespace flocklift
