// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a fit found, for its summary and for people. What is not determined is told as unknown, not
// as a number.

#ifndef FLOCKLIFT_TOOLS_FIT_FIGURES_H_
#define FLOCKLIFT_TOOLS_FIT_FIGURES_H_

#include <nlohmann/json.hpp>

#include "reconstruct/fit/fit.h"

namespace flocklift {

nlohmann::ordered_json FitFigures(const FitResult& result);
void PrintFit(const FitResult& result);  // on standard error

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_FIT_FIGURES_H_
