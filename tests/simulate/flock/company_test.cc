// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/company.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

template <typename T>
Crowd<T> AsCrowd(Bodies<T>* bodies) {
  return {bodies->size(), bodies->x.data(), bodies->y.data(), bodies->z.data(), T(0), nullptr};
}

template <typename T>
std::vector<std::uint32_t> FindBy(Company<T>* company, std::vector<Bodies<T>> groups, T reach) {
  std::vector<Crowd<T>> crowds;
  for (Bodies<T>& group : groups) crowds.push_back(AsCrowd(&group));
  ThreadPool pool(1);
  company->Find(crowds, Around<T>(BoxesOf<T>(crowds, &pool)), reach);
  std::vector<std::uint32_t> found;
  for (const auto& animal : company->found()) found.push_back(animal.animal);
  return found;
}

template <typename T>
std::vector<std::uint32_t> Find(const std::vector<Bodies<T>>& groups, T reach) {
  Company<T> company;
  return FindBy(&company, groups, reach);
}

template <typename T>
std::set<std::uint32_t> BruteForce(const std::vector<Bodies<T>>& groups, T reach) {
  std::vector<Vec3<T>> all;
  for (const Bodies<T>& group : groups) {
    for (std::size_t k = 0; k < group.size(); ++k) all.push_back(group.Position(k));
  }
  std::set<std::uint32_t> found;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    for (std::uint32_t j = i + 1; j < all.size(); ++j) {
      if (SquaredNorm(all[j] - all[i]) < reach * reach) found.insert({i, j});
    }
  }
  return found;
}

template <typename T>
void ExpectAllFound(const std::vector<Bodies<T>>& groups, T reach) {
  const std::vector<std::uint32_t> found = Find(groups, reach);
  const std::set<std::uint32_t> some(found.begin(), found.end());
  EXPECT_EQ(some.size(), found.size());
  for (const std::uint32_t animal : BruteForce(groups, reach)) {
    EXPECT_TRUE(some.contains(animal)) << animal;
  }
}

TEST(Company, HasAllThatAreNearSomebody) {
  for (const NamedFlock& flock :
       {RandomFlock("sparse", 2000, {9, 8, 7}, 1), RandomFlock("flat", 2000, {20, 0, 9}, 2),
        RandomFlock("a line", 2000, {0, 90, 0}, 3), RandomFlock("crush", 300, {1, 1, 1}, 4),
        RandomFlock("one place", 40, {0, 0, 0}, 5),
        RandomFlock("too wide for order", 900, {5e6, 3, 0}, 6)}) {
    SCOPED_TRACE(flock.name);
    for (const double reach : {0.02, 0.1, 0.6}) {
      ExpectAllFound<double>({AsBodies<double>(flock)}, reach);
      ExpectAllFound<float>({AsBodies<float>(flock)}, static_cast<float>(reach));
    }
  }
}

TEST(Company, CountsThroughCrowds) {
  ExpectAllFound<float>({AsBodies<float>(RandomFlock("", 700, {4, 4, 4}, 7)),
                         AsBodies<float>(RandomFlock("", 0, {}, 8)),
                         AsBodies<float>(RandomFlock("", 801, {4, 4, 4}, 9))},
                        0.1F);
}

TEST(Company, IsNotSomebodyFarAway) {
  const std::vector<Bodies<float>> flock = {
      AsBodies<float>(RandomFlock("", 20000, {60, 60, 60}, 10))};
  const std::size_t near = BruteForce(flock, 0.2F).size(), found = Find(flock, 0.2F).size();
  EXPECT_GT(near, 10);
  EXPECT_LT(found, near + 20000 / 8);
}

// As many bits as before, more, and fewer.
TEST(Company, RemembersNothing) {
  Company<float> company;
  for (const int n : {3000, 3000, 9000, 70000, 500, 6000}) {
    const std::vector<Bodies<float>> flock = {
        AsBodies<float>(RandomFlock("", n, {40, 40, 40}, static_cast<std::uint64_t>(n)))};
    const auto fresh = Find(flock, 0.2F);
    EXPECT_EQ(FindBy(&company, flock, 0.2F), fresh) << n;
    EXPECT_LT(fresh.size(), flock[0].size() / 2);
  }
}

TEST(Company, WhatIsNoNumberIsNowhere) {
  Bodies<float> flock = AsBodies<float>(RandomFlock("", 100, {3, 3, 3}, 12));
  flock.x[17] = std::numeric_limits<float>::quiet_NaN();
  flock.y[40] = std::numeric_limits<float>::infinity();
  ExpectAllFound<float>({flock}, 0.3F);
}

}  // namespace
}  // namespace flocklift
