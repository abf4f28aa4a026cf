// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace flocklift {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string FaultOf(const ModelSpec& spec) {
  try {
    ResolveModel(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Model, EveryParameterIsDescribedOnceAndItsDefaultIsLegal) {
  ASSERT_GE(Models().size(), 4U);
  for (const ModelInfo& model : Models()) {
    EXPECT_FALSE(model.help.empty());
    EXPECT_FALSE(model.source.empty());
    std::set<std::string> names;
    for (const ParameterInfo& p : model.parameters) {
      EXPECT_TRUE(names.insert(p.name).second) << p.name;
      EXPECT_GE(p.value, p.range.low) << model.name << " " << p.name;
      EXPECT_LE(p.value, p.range.high) << model.name << " " << p.name;
      EXPECT_FALSE(p.help.empty());
    }
    EXPECT_EQ(FindModel(model.name), &model);
  }
  EXPECT_EQ(FindModel("no such model"), nullptr);
}

TEST(Model, AssignmentHasThePublishedNumbers) {
  const auto p = std::get<BoidsParameters<double>>(ResolveModel({"boids2d", {}, "", {}}));
  EXPECT_EQ(p.d_s, 30);
  EXPECT_EQ(p.d_v, 150);
  EXPECT_EQ(p.alpha_s, 0.02);
  EXPECT_EQ(p.alpha_c, 0.001);
  EXPECT_EQ(p.alpha_a, 0.03);
  EXPECT_EQ(p.alpha_b, 0.5);
  EXPECT_EQ(p.s_min, 5);
  EXPECT_EQ(p.s_max, 10);
  EXPECT_EQ(p.taper, 0);
  EXPECT_EQ(p.noise, 0);
}

TEST(Model, WhatTheSpecSaysWins) {
  const ModelSpec spec{"lin", {{"w_sep", 0.25}, {"exponent", 1}}, "", {}};
  const auto p = std::get<LinParameters<double>>(ResolveModel(spec));
  EXPECT_EQ(p.w_sep, 0.25);
  EXPECT_EQ(p.exponent, 1);
  EXPECT_EQ(p.d_sep, LinParameters<double>{}.d_sep);

  const ModelSpec complete = CompleteModel(spec);
  EXPECT_EQ(complete.parameters.size(), FindModel("lin")->parameters.size());
  EXPECT_EQ(complete.parameters.at("w_sep"), 0.25);
  EXPECT_EQ(complete.parameters.at("d_sep"), p.d_sep);
}

TEST(Model, FaultsNameTheirPlaceAndTheNearestName) {
  EXPECT_THAT(FaultOf({"boid", {}, "a.toml:7", {}}),
              AllOf(HasSubstr("a.toml:7: "), HasSubstr("`boid`"), HasSubstr("boids")));
  EXPECT_THAT(FaultOf({"boids", {{"alpha_x", 1}}, "a.toml:7", {{"alpha_x", "a.toml:9"}}}),
              AllOf(HasSubstr("a.toml:9: "), HasSubstr("`alpha_x`"), HasSubstr("alpha_")));
  EXPECT_THAT(FaultOf({"boids", {{"d_s", -1}}, "a.toml:7", {{"d_s", "a.toml:8"}}}),
              AllOf(HasSubstr("a.toml:8: "), HasSubstr("d_s"), HasSubstr("-1")));
  EXPECT_THAT(FaultOf({"lin", {{"w_sep", std::nan("")}}, "", {}}), HasSubstr("w_sep"));
  EXPECT_EQ(FaultOf({"boids", {{"d_s", 1}}, "", {}}), "");
}

}  // namespace
}  // namespace flocklift
