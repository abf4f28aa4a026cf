// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::string_view kColours[] = {"red", "green", "blue"};

struct Paint {
  double coats = 2;
  Choice colour{kColours, 1};
};
template <typename Visitor>
void Describe(Visitor& visit, Paint& p) {
  visit("coats", p.coats, {.low = 1, .high = 9}, "", "how many");
  visit("colour", p.colour, {}, "", "which");
}

Registry<std::variant<Paint>> Paints() { return {"paint", {{"paint", "", "", Paint{}}}}; }

ModelSpec Spec(const std::map<std::string, double>& numbers,
               const std::map<std::string, std::string>& words) {
  return {.name = "paint",
          .parameters = numbers,
          .where = "a.toml:1",
          .where_of = {},
          .choices = words};
}

std::string FaultOf(const ModelSpec& spec) {
  try {
    Paints().Resolve(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Registry, ChoicesAreWords) {
  const Paint paint = std::get<Paint>(Paints().Resolve(Spec({{"coats", 3}}, {{"colour", "blue"}})));
  EXPECT_EQ(paint.coats, 3);
  EXPECT_EQ(paint.colour.name(), "blue");
  EXPECT_EQ(std::get<Paint>(Paints().Resolve(Spec({}, {}))).colour.name(), "green");
  const ModelInfo info = Paints().infos()[0];
  EXPECT_EQ(info.parameters[1].choices, (std::vector<std::string>{"red", "green", "blue"}));
  EXPECT_EQ(info.parameters[1].value, 1);
}

TEST(Registry, CompleteSpellsOutBothKinds) {
  const ModelSpec complete = Paints().Complete(Spec({}, {{"colour", "red"}}));
  EXPECT_EQ(complete.parameters.at("coats"), 2);
  EXPECT_EQ(complete.choices.at("colour"), "red");
}

TEST(Registry, FaultsOfChoices) {
  EXPECT_THAT(FaultOf(Spec({}, {{"colour", "grean"}})),
              AllOf(HasSubstr("a.toml:1: "), HasSubstr("`grean`"), HasSubstr("green")));
  EXPECT_THAT(FaultOf(Spec({{"colour", 1}}, {})), HasSubstr("number"));
  EXPECT_THAT(FaultOf(Spec({}, {{"coats", "many"}})), HasSubstr("word"));
  EXPECT_THAT(FaultOf(Spec({}, {{"color", "red"}})), HasSubstr("colour"));
}

}  // namespace
}  // namespace flocklift
