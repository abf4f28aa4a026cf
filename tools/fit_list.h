// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What `fit --free` may name: the numbers of a model and of the force terms that a scene adds.

#ifndef FLOCKLIFT_TOOLS_FIT_LIST_H_
#define FLOCKLIFT_TOOLS_FIT_LIST_H_

#include <string>

#include "simulate/core/scene.h"

namespace flocklift {

// A line each: name, value, unit, what it is. Throws InputError as CompleteModel does.
std::string ListNumbers(const ModelSpec& model);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_FIT_LIST_H_
