// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/presets.h"

#include "simulate/core/check.h"

namespace flocklift {

const std::vector<SpeciesPreset>& SpeciesPresets() {
  static const std::vector<SpeciesPreset> presets = {
      // Transit flocks fly at 10 to 13 m/s: Ling et al., Nature Communications 10, 5174 (2019).
      {"jackdaw", {0.70, 0.018}, {11.5, 1.5}},
      // 37-42 cm; murmurations at about 10 m/s: Ballerini et al., Animal Behaviour 76, 201 (2008).
      {"starling", {0.40, 0.013}, {10.5, 1.5}},
      // 63-70 cm; homing flocks at 13 to 18 m/s: Nagy et al., Nature 464, 890 (2010).
      {"pigeon", {0.66, 0.018}, {15.5, 2}},
      // 81-99 cm.
      {"rook", {0.90, 0.045}, {12.5, 1.9}},
      // 93-104 cm.
      {"crow", {0.98, 0.028}, {13, 1.9}},
      // 32-35 cm; foraging at 8 to 12 m/s.
      {"swallow", {0.335, 0.008}, {10, 1.5}},
      // 42-48 cm; Henningsson et al., J. R. Soc. Interface 7, 94 (2010), for cruising swifts.
      {"swift", {0.45, 0.015}, {10, 1.5}},
      // 155-165 cm, soaring and migrating.
      {"stork", {1.60, 0.05}, {12, 2}},
      // 220-245 cm, migrating in flapping flight.
      {"crane", {2.30, 0.06}, {15, 2}},
      // 147-180 cm.
      {"goose", {1.63, 0.08}, {16, 2}},
      // 100-110 cm.
      {"gull", {1.05, 0.025}, {11, 1.7}},
      // 32-34 cm.
      {"dunlin", {0.36, 0.015}, {14, 2}},
  };
  return presets;
}

const SpeciesPreset& PresetOf(std::string_view name) {
  std::string names;
  for (const SpeciesPreset& preset : SpeciesPresets()) {
    if (preset.name == name) return preset;
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  }
  Check(false, "there is no preset " + std::string(name) + "; there are " + names);
  return SpeciesPresets().front();
}

}  // namespace flocklift
