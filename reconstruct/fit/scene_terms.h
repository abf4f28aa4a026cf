// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The force terms that a scene adds to a species ([[species.force]]) as estimators need them: what
// each does to the animals at positions x with velocities v, by the same templated formulas that
// the simulator's passes run (simulate/flock/force_passes.cc). Known are terms of the state, and of
// surroundings that stay as they are; predators, gusts and fields of noise are not. Noise is what
// an estimate leaves over. World frame; metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_SCENE_TERMS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_SCENE_TERMS_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reconstruct/fit/process_model.h"
#include "reconstruct/fit/term_surroundings.h"
#include "simulate/flock/force_types.h"

namespace flocklift {

// The parameters by which accelerations of the model's terms are linear: the gain, rate or g of
// each, by the names of simulate/core/model_terms.h.
std::vector<std::string> TermWeights(const ModelSpec& model);

// The parameters of the model's terms that a state-space estimate can free; nothing where one of
// them is not smooth: a hard edge, a cruising speed, a noise with a memory or in space.
std::optional<std::vector<std::string>> SmoothTermParameters(const ModelSpec& model);

// Why a term of the model is no function of the state alone, in a line; empty where none is.
std::string UnknownTerm(const ModelSpec& model);

// The rate of the return to cruising speeds, summed over the terms [1/s].
double CruiseRateOfTerms(const ModelSpec& model);

class SceneTerms {
 public:
  // `free`: names of the estimate's unknowns, those of the model's own among them.
  SceneTerms(const ModelSpec& model, std::vector<std::string> free, TermSurroundings around);

  bool empty() const { return terms_.empty(); }

  // Adds to each animal's row of `out`, free.size() + 2 columns, the terms with weight 1 whose
  // weight is free, and to the column after them all others; `cruising_speed` as in flock_terms.h.
  void AddColumns(double cruising_speed, std::span<const Vec3d> x, std::span<const Vec3d> v,
                  std::span<Vec3d> out) const;

  // Adds accelerations, and where `slopes` is not empty slopes, with theta in place of `free`.
  void AddAccelerations(std::span<const double> theta, std::span<const Vec3d> x,
                        std::span<const Vec3d> v, std::span<Vec3d> a,
                        std::span<OwnSlope> slopes) const;

 private:
  struct Term {
    std::string name;        // TermNames
    ForceParameters unit;    // with weight 1, where it has one
    ForceParameters given;   // with its own
    std::size_t column = 0;  // of its weight, or the known ones'
    double weight = 1;       // there
  };

  std::vector<std::string> free_;
  TermSurroundings around_;
  std::vector<Term> terms_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_SCENE_TERMS_H_
