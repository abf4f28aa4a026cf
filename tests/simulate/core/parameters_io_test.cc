// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "simulate/core/parameters.h"
#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

Parameters Parse(const std::string& text) { return ParseParameters(text, "FILE"); }

Parameters Example() {
  Parameters parameters;
  parameters.model.name = "boids";
  parameters.model.parameters = {{"a", 0.1}, {"b", -1e-20}, {"c d", 1.0 / 3}};
  ModelSpec near{.name = "alignment", .parameters = {}, .where = {}, .where_of = {}};
  near.parameters = {{"gain", 0.3}, {"radius", 2}};
  ModelSpec far = near;
  far.parameters["gain"] = -0.1;
  parameters.model.terms = {near, far};
  parameters.posterior = {.free = {"c d", "a", "alignment2.gain"},
                          .sd = {0.25, INFINITY, 0.5},
                          .correlation = {1, -0.7, 0, -0.7, 1, 0, 0, 0, 1},
                          .determined = {true, false, true}};
  parameters.goals = {
      {.species = {}, .position = {1, -2, 0.1}, .radius = 3, .period = 20, .weight = 1.0 / 3}};
  parameters.walls = Region{{-1, -2, -3}, {1, 2, 3.5}};
  return parameters;
}

TEST(Parameters, SurviveAFile) {
  const TemporaryFolder folder;
  const Parameters written = Example();
  WriteParameters(folder / "parameters.toml", written);
  const Parameters read = ReadParameters(folder / "parameters.toml");
  EXPECT_EQ(read.model.name, written.model.name);
  EXPECT_EQ(read.model.parameters, written.model.parameters);
  ASSERT_EQ(read.model.terms.size(), 2U);
  EXPECT_EQ(read.model.terms[1].name, "alignment");
  EXPECT_EQ(read.model.terms[1].parameters, written.model.terms[1].parameters);
  EXPECT_EQ(read.posterior.free, written.posterior.free);
  EXPECT_EQ(read.posterior.sd, written.posterior.sd);
  EXPECT_EQ(read.posterior.correlation, written.posterior.correlation);
  EXPECT_EQ(read.posterior.determined, written.posterior.determined);
  ASSERT_EQ(read.goals.size(), 1U);
  EXPECT_EQ(read.goals[0].position, written.goals[0].position);
  EXPECT_EQ(read.goals[0].radius, 3);
  EXPECT_EQ(read.goals[0].period, 20);
  EXPECT_EQ(read.goals[0].weight, 1.0 / 3);
  ASSERT_TRUE(read.walls.has_value());
  EXPECT_EQ(read.walls->low, written.walls->low);
  EXPECT_EQ(read.walls->high, written.walls->high);
  EXPECT_EQ(read.model.where, (folder / "parameters.toml").string() + ":2");
  EXPECT_EQ(read.model.WhereOf("b"), (folder / "parameters.toml").string() + ":6");
}

TEST(Parameters, MayLackAPosterior) {
  const Parameters parameters = Parse("[model]\nname = \"lin\"\nparameters = { k = 1 }\n");
  EXPECT_EQ(parameters.model.name, "lin");
  EXPECT_EQ(parameters.model.parameters.at("k"), 1);
  EXPECT_TRUE(parameters.posterior.free.empty());
  EXPECT_EQ(FormatParameters(Parse(FormatParameters(parameters))), FormatParameters(parameters));
}

TEST(Parameters, PosteriorMustFitTogether) {
  Parameters parameters = Example();
  parameters.posterior.sd.pop_back();
  EXPECT_THROW(FormatParameters(parameters), std::invalid_argument);
}

TEST(Parameters, FaultsAreTold) {
  const std::string model = "[model]\nname = \"boids\"\n[model.parameters]\na = 1\nb = 2\n";
  const std::string posterior = model + "[posterior]\n";  // line 6
  const std::string free = posterior + "free = [\"a\", \"b\"]\n";
  const std::string sd = free + "determined = [true, true]\nsd = [1, 2]\n";
  const std::vector<Fault> faults{
      {"", 0, "no table [model]"},
      {"[model]\n", 1, "name is missing in [model]"},
      {"[model]\nname = 3\n", 2, "not text"},
      {"[model]\nname = \"a\"\nparameter = 3\n", 3, "did you mean `parameters`?"},
      {"[model]\nname = \"a\"\nparameters = { k = true }\n", 3, "`k` in [model.parameters]"},
      {model + "[posterio]\n", 6, "did you mean `posterior`?"},
      {model + "[[goal]]\nweight = 1\n", 6, "position is missing"},
      {model + "[[goal]]\nposition = [0, 0, 0]\nspecies = \"a\"\n", 8, "unknown key `species`"},
      {model + "[world]\nbox = 3\n", 7, "box"},
      {model + "[world]\nwalls = 3\n", 7, "unknown key `walls`"},
      {posterior, 6, "free is missing"},
      {posterior + "free = \"a\"\n", 7, "free in [posterior] is not a list"},
      {posterior + "free = [1]\n", 7, "free holds no name"},
      {posterior + "free = [\"c\"]\n", 7, "free names `c`, which [model.parameters] lacks"},
      {posterior + "free = [\"a\", \"a\"]\n", 7, "free names `a` twice"},
      {free, 6, "determined is missing"},
      {free + "determined = [true]\n", 8, "determined has 1 elements, free has 2"},
      {free + "determined = [true, 1]\n", 8, "determined holds no truth value"},
      {free + "determined = [true, true]\n", 6, "sd is missing"},
      {free + "determined = [true, true]\nsd = [1, -1]\n", 9, "sd holds no standard deviation"},
      {free + "determined = [true, true]\nsd = [1, inf]\n", 9, "sd holds no standard deviation"},
      {free + "determined = [true, false]\nsd = [1, nan]\n", 9, "sd holds no standard deviation"},
      {sd, 6, "correlation is missing"},
      {sd + "correlation = [1, 2]\n", 10, "correlation holds no rows"},
      {sd + "correlation = [[1, 0]]\n", 10, "correlation has 1 elements"},
      {sd + "correlation = [[1, 0],\n[0]]\n", 11, "a row of correlation has 1 elements"},
      {sd + "correlation = [[1, 2], [2, 1]]\n", 10, "no number from -1 to 1"},
      {sd + "correlation = [[1, nan], [0, 1]]\n", 10, "no number from -1 to 1"},
      {sd + "correlation = [[1, 0.5],\n[0.4, 1]]\n", 10, "not symmetric at row 1, column 2"},
      {sd + "correlation = [[1, 0.5],\n[0.5, 0.9]]\n", 11, "not 1 at row 2, column 2"},
      {sd + "correlation = [[1, 0], [0, 1]]\nmean = 3\n", 11, "unknown key `mean`"},
  };
  for (const Fault& fault : faults) ExpectFault(fault, Parse);
}

}  // namespace
}  // namespace flocklift
