// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/known_within.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace flocklift::internal {

void FlagLooselyKnown(double share, FitResult* result) {
  if (!(share > 0)) return;
  ParameterPosterior& posterior = result->parameters.posterior;
  std::string names;
  for (std::size_t k = 0; k < result->weights.size(); ++k) {
    FittedWeight& weight = result->weights[k];
    if (!weight.determined || 3 * weight.sd <= share * std::abs(weight.estimate)) continue;
    weight.determined = false;
    if (k < posterior.determined.size()) posterior.determined[k] = false;  // else the goal's
    names += (names.empty() ? " " : ", ") + weight.name;
  }
  if (names.empty()) return;
  result->warnings.push_back(
      fmt::format("the data do not determine to within {:.3g} %:{}", 100 * share, names));
}

}  // namespace flocklift::internal
