// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/fit_list.h"

#include <fmt/format.h>

#include <iterator>

#include "simulate/core/model_terms.h"
#include "simulate/flock/model.h"

namespace flocklift {

std::string ListNumbers(const ModelSpec& model) {
  const ModelSpec complete = CompleteModel(model);
  std::string text;
  for (const std::string& name : NumberNames(complete)) {
    const ParameterInfo* const info = FindParameter(complete, name);
    fmt::format_to(std::back_inserter(text), "{:<24} {:>10.6g} {:<8} {}\n", name,
                   *FindNumber(complete, name), info->unit, info->help);
  }
  return text;
}

}  // namespace flocklift
