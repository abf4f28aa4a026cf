// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/model_terms.h"

#include <gtest/gtest.h>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

ModelSpec Example() {
  const auto term = [](const char* type, double gain) {
    return ModelSpec{.name = type, .parameters = {{"gain", gain}}, .where = {}, .where_of = {}};
  };
  ModelSpec model{.name = "forces", .parameters = {{"s_max", 9}}, .where = {}, .where_of = {}};
  model.terms = {term("alignment", 1), term("drag", 2), term("alignment", 3)};
  return model;
}

TEST(ModelTerms, ANumberTellsTermsOfOneTypeApart) {
  const ModelSpec model = Example();
  EXPECT_EQ(TermNames(model.terms), (std::vector<std::string>{"alignment", "drag", "alignment2"}));
  EXPECT_EQ(NumberNames(model),
            (std::vector<std::string>{"s_max", "alignment.gain", "drag.gain", "alignment2.gain"}));
  EXPECT_EQ(*FindNumber(model, "s_max"), 9);
  EXPECT_EQ(*FindNumber(model, "alignment.gain"), 1);
  EXPECT_EQ(*FindNumber(model, "alignment2.gain"), 3);
  for (const char* none : {"gain", "alignment3.gain", "drag.rate", "forces.s_max", ".", "drag."}) {
    EXPECT_EQ(FindNumber(model, none), nullptr) << none;
  }
}

TEST(ModelTerms, SetsANumberOrSuggestsItsName) {
  ModelSpec model = Example();
  SetNumber("alignment2.gain", 7, "HERE", &model);
  EXPECT_EQ(*FindNumber(model, "alignment.gain"), 1);
  EXPECT_EQ(*FindNumber(model, "alignment2.gain"), 7);
  EXPECT_EQ(model.terms[2].WhereOf("gain"), "HERE");
  try {
    SetNumber("drag.gian", 1, "HERE", &model);
    ADD_FAILURE();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_TRUE(text.starts_with("HERE")) << text;
    EXPECT_NE(text.find("drag.gain"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace flocklift
