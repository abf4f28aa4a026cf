// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wingspan and flight speed of some species whose flocks people film.

#ifndef FLOCKLIFT_RECONSTRUCT_PRESETS_H_
#define FLOCKLIFT_RECONSTRUCT_PRESETS_H_

#include <string>
#include <string_view>
#include <vector>

#include "reconstruct/knowledge.h"

namespace flocklift {

struct SpeciesPreset {
  std::string_view name;
  Uncertain wingspan;  // mean, and sd between animals [m]
  Uncertain speed;     // of a flying flock: mean, and how sure that mean is [m/s]
};

// Sources: wingspans from the ranges of Snow and Perrins, The Birds of the Western Palearctic
// (concise edition, 1998), sd a quarter of the range; speeds where not said otherwise from
// Alerstam et al., Flight speeds among bird species, PLoS Biology 5, e197 (2007), or the paper
// named, sd 10 to 20 % because flocks change their speed.
const std::vector<SpeciesPreset>& SpeciesPresets();

// Throws std::invalid_argument that lists the names.
const SpeciesPreset& PresetOf(std::string_view name);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_PRESETS_H_
