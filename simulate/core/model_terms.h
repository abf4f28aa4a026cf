// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The numbers of a model and of the force terms that add to it, under one name each: `alpha_c` of
// the model's own; `alignment.gain` of a term, and of a second one of the same type
// `alignment2.gain`.

#ifndef FLOCKLIFT_SIMULATE_CORE_MODEL_TERMS_H_
#define FLOCKLIFT_SIMULATE_CORE_MODEL_TERMS_H_

#include <string>
#include <utility>
#include <vector>

#include "simulate/core/scene.h"

namespace flocklift {

// What each term is called, in their order: by its type, with a number from the second on.
std::vector<std::string> TermNames(const std::vector<ModelSpec>& terms);

// All numbers that the model spells out: its own by name, then those of its terms in their order.
std::vector<std::string> NumberNames(const ModelSpec& model);

// Null where the model does not spell out a number of that name.
const double* FindNumber(const ModelSpec& model, const std::string& name);
double* FindNumber(ModelSpec* model, const std::string& name);

// The term that a name speaks of and its parameter; null and the whole name where it is none of the
// terms'.
std::pair<const ModelSpec*, std::string> SplitName(const ModelSpec& model, const std::string& name);

// Throws InputError that says where it was set, and suggests the nearest name, for one that the
// model does not spell out.
void SetNumber(const std::string& name, double value, const std::string& where, ModelSpec* model);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_MODEL_TERMS_H_
