// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/model_terms.h"

#include <map>

#include "simulate/core/check.h"
#include "simulate/core/suggest.h"

namespace flocklift {

std::vector<std::string> TermNames(const std::vector<ModelSpec>& terms) {
  std::vector<std::string> names;
  std::map<std::string, int> count;
  for (const ModelSpec& term : terms) {
    const int number = ++count[term.name];
    names.push_back(number == 1 ? term.name : term.name + std::to_string(number));
  }
  return names;
}

std::vector<std::string> NumberNames(const ModelSpec& model) {
  std::vector<std::string> names;
  for (const auto& [name, value] : model.parameters) names.push_back(name);
  const std::vector<std::string> terms = TermNames(model.terms);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    for (const auto& [name, value] : model.terms[k].parameters) {
      names.push_back(terms[k] + "." + name);
    }
  }
  return names;
}

std::pair<const ModelSpec*, std::string> SplitName(const ModelSpec& model,
                                                   const std::string& name) {
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos) return {nullptr, name};
  const std::vector<std::string> terms = TermNames(model.terms);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (terms[k] == name.substr(0, dot)) return {&model.terms[k], name.substr(dot + 1)};
  }
  return {nullptr, name};
}

const double* FindNumber(const ModelSpec& model, const std::string& name) {
  const auto [term, own] = SplitName(model, name);
  const ModelSpec& of = term == nullptr ? model : *term;
  const auto found = of.parameters.find(own);
  return found == of.parameters.end() ? nullptr : &found->second;
}

double* FindNumber(ModelSpec* model, const std::string& name) {
  return const_cast<double*>(FindNumber(*model, name));
}

void SetNumber(const std::string& name, double value, const std::string& where, ModelSpec* model) {
  double* const number = FindNumber(model, name);
  if (number == nullptr) {
    throw InputError(where, 0, "model " + model->name + " has no number `" + name + "`",
                     SuggestName(name, NumberNames(*model)));
  }
  *number = value;
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos) {
    model->where_of[name] = where;
    return;
  }
  const std::vector<std::string> terms = TermNames(model->terms);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (terms[k] == name.substr(0, dot)) model->terms[k].where_of[name.substr(dot + 1)] = where;
  }
}

}  // namespace flocklift
