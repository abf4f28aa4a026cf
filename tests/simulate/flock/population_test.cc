// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/population.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <variant>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

Scene SmallScene() {
  Scene scene;
  SpeciesSpec species;
  species.count = 20;
  scene.species = {species};
  return scene;
}

TEST(Populate, MeansOfTheIndividualsAreTheScenes) {
  Scene scene = SmallScene();
  scene.species[0].wingspan = 1.1;
  scene.species[0].speed = 12;
  const Population population = Populate(scene);
  double wingspan = 0, speed = 0, wingspan_square = 0, speed_square = 0;
  for (const Animal& animal : population.animals) {
    wingspan += animal.wingspan / 20;
    wingspan_square += std::pow(animal.wingspan / 1.1 - 1, 2) / 19;
    EXPECT_NEAR(animal.body_length / animal.wingspan, 0.35 / 1.1, 1e-12);
  }
  for (const double own : population.swarms[0].cruising_speed) {
    speed += own / 20;
    speed_square += std::pow(own / 12 - 1, 2) / 19;
  }
  EXPECT_NEAR(wingspan, 1.1, 1e-12);
  EXPECT_NEAR(speed, 12, 1e-12);
  EXPECT_NEAR(std::sqrt(wingspan_square), 0.05, 0.02);
  EXPECT_NEAR(std::sqrt(speed_square), 0.08, 0.03);
}

TEST(Populate, StartsInTheMiddleHalfOrWhereToldAndTowardsTheGoal) {
  Scene scene = SmallScene();
  const Population middle = Populate(scene);
  for (const Vec3d& x : middle.swarms[0].position) {
    EXPECT_LE(std::abs(x.x), 10);
    EXPECT_LE(std::abs(x.y), 10);
    EXPECT_LE(std::abs(x.z - 12), 5);
  }
  scene.species[0].start = Region{{50, 0, 0}, {51, 1, 1}};
  scene.goals = {{.species = "", .position = {-1000, 0, 0}}};
  const Population population = Populate(scene);
  for (const Vec3d& x : population.swarms[0].position) EXPECT_NEAR(x.x, 50.5, 0.5);
  Vec3d mean;
  for (const Vec3d& v : population.swarms[0].velocity) mean += v;
  EXPECT_GT(Dot(Normalized(mean), Vec3d{-1, 0, 0}), 0.95);
}

TEST(Populate, SpeciesFlockTogetherUnderTheirOwnModels) {
  Scene scene = SmallScene();
  SpeciesSpec second = scene.species[0];
  second.name = "second";
  second.count = 7;
  second.model.name = "lin";
  scene.species.push_back(second);
  scene.predators = {PredatorSpec{.count = 2}};
  const Population population = Populate(scene);
  ASSERT_EQ(population.swarms.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<LinParameters<double>>(population.swarms[1].model));
  ASSERT_EQ(population.animals.size(), 29U);
  std::set<Id> ids;
  for (const Animal& animal : population.animals) ids.insert(animal.id);
  EXPECT_EQ(*ids.begin(), 1);
  EXPECT_EQ(*ids.rbegin(), 29);
  EXPECT_EQ(ids.size(), 29U);
}

TEST(Populate, WrongModelsAreInputErrors) {
  Scene scene = SmallScene();
  scene.species[0].model.parameters["alpha"] = 1;
  EXPECT_THROW(Populate(scene), InputError);
}

}  // namespace
}  // namespace flocklift
