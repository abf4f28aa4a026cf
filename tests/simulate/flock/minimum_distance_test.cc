// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/minimum_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

// A species of the test: where its animals are, and the room of each.
template <typename T>
struct Group {
  std::vector<T> x, y, z, body;
  T room = 0;

  Group(const NamedFlock& flock, double room_of_each) : room(static_cast<T>(room_of_each)) {
    for (const Vec3d& at : flock.position) Add(at);
  }
  void Add(const Vec3d& at) {
    x.push_back(static_cast<T>(at.x));
    y.push_back(static_cast<T>(at.y));
    z.push_back(static_cast<T>(at.z));
  }
  Crowd<T> AsCrowd() {
    return {x.size(), x.data(), y.data(), z.data(), room, body.empty() ? nullptr : body.data()};
  }
  Vec3d At(std::size_t k) const {
    return {static_cast<double>(x[k]), static_cast<double>(y[k]), static_cast<double>(z[k])};
  }
  double Room(std::size_t k) const {
    return static_cast<double>(room) + (body.empty() ? 0 : static_cast<double>(body[k]));
  }
};

template <typename T>
std::int64_t Enforce(std::vector<Group<T>>* groups, int threads = 1) {
  std::vector<Crowd<T>> crowds;
  for (Group<T>& group : *groups) crowds.push_back(group.AsCrowd());
  ThreadPool pool(threads);
  return MinimumDistance<T>{}.Enforce(crowds, &pool);
}

struct Expected {
  std::vector<Vec3d> position;
  std::set<std::size_t> touched;
};

// All pairs.
template <typename T>
Expected BruteForce(const std::vector<Group<T>>& groups) {
  std::vector<Vec3d> position;
  std::vector<double> room;
  for (const Group<T>& group : groups) {
    for (std::size_t k = 0; k < group.x.size(); ++k) {
      position.push_back(group.At(k));
      room.push_back(group.Room(k));
    }
  }
  Expected expected{position, {}};
  for (std::size_t i = 0; i < position.size(); ++i) {
    for (std::size_t j = i + 1; j < position.size(); ++j) {
      const Vec3d r = position[j] - position[i];
      const double missing = room[i] + room[j] - Norm(r);
      if (missing <= 0) continue;
      const Vec3d push = 0.5 * missing * (Norm(r) > 0 ? r / Norm(r) : Vec3d{1, 0, 0});
      expected.position[i] -= push;
      expected.position[j] += push;
      expected.touched.insert({i, j});
    }
  }
  return expected;
}

template <typename T>
void ExpectAsBruteForce(std::vector<Group<T>> groups, double tolerance) {
  const Expected expected = BruteForce(groups);
  EXPECT_EQ(Enforce(&groups), static_cast<std::int64_t>(expected.touched.size()));
  std::size_t at = 0;
  for (const Group<T>& group : groups) {
    for (std::size_t k = 0; k < group.x.size(); ++k, ++at) {
      EXPECT_LT(Norm(group.At(k) - expected.position[at]), tolerance) << at;
    }
  }
}

TEST(MinimumDistance, ByHand) {
  NamedFlock flock{"", {{0, 0, 0}, {0.6, 0, 0}, {5, 5, 5}}, {}};
  std::vector<Group<double>> groups = {Group<double>(flock, 0.5)};
  EXPECT_EQ(Enforce(&groups), 2);
  EXPECT_NEAR(groups[0].x[0], -0.2, 1e-15);  // 0.4 m are missing, half of it each
  EXPECT_NEAR(groups[0].x[1], 0.8, 1e-15);
  EXPECT_EQ(groups[0].At(2), (Vec3d{5, 5, 5}));
  EXPECT_EQ(Enforce(&groups), 0);
}

TEST(MinimumDistance, AnimalsInOnePlacePartAlongX) {
  std::vector<Group<double>> groups = {Group<double>({"", {{1, 2, 3}, {1, 2, 3}}, {}}, 0.5)};
  EXPECT_EQ(Enforce(&groups), 2);
  EXPECT_EQ(groups[0].At(0), (Vec3d{0.5, 2, 3}));
  EXPECT_EQ(groups[0].At(1), (Vec3d{1.5, 2, 3}));
}

TEST(MinimumDistance, IsThatOfAllPairs) {
  for (const NamedFlock& flock : ManyFlocks()) {
    SCOPED_TRACE(flock.name);
    for (const double room : {0.02, 0.2, 0.7}) {
      std::vector<Group<double>> groups = {Group<double>(flock, room)};
      ExpectAsBruteForce(groups, 1e-9);
    }
  }
}

TEST(MinimumDistance, FloatIsThatOfAllPairs) {
  for (const double room : {0.05, 0.3}) {
    ExpectAsBruteForce<float>({Group<float>(RandomFlock("", 800, {6, 5, 4}, 21), room)}, 2e-5);
  }
}

TEST(MinimumDistance, BodiesAndSpeciesCount) {
  std::vector<Group<double>> groups = {Group<double>(RandomFlock("", 300, {5, 5, 5}, 31), 0.1),
                                       Group<double>(RandomFlock("", 1, {5, 5, 5}, 32), 0),
                                       Group<double>(RandomFlock("", 0, {}, 33), 0.3),
                                       Group<double>(RandomFlock("", 200, {5, 5, 5}, 34), 0.25)};
  Rng rng(35);
  for (int k = 0; k < 300; ++k) groups[0].body.push_back(rng.Uniform(0, 0.2));
  groups[1].body.push_back(1.2);
  ExpectAsBruteForce(groups, 1e-12);
}

TEST(MinimumDistance, KeepsTheCentreOfMass) {
  std::vector<Group<double>> groups = {Group<double>(RandomFlock("", 500, {4, 4, 4}, 41), 0.2)};
  const auto centre = [&groups] {
    Vec3d sum;
    for (std::size_t k = 0; k < groups[0].x.size(); ++k) sum += groups[0].At(k);
    return sum;
  };
  const Vec3d before = centre();
  EXPECT_GT(Enforce(&groups), 100);
  EXPECT_LT(Norm(centre() - before), 1e-10);
}

TEST(MinimumDistance, RepeatedEnforcementEndsTheCrush) {
  std::vector<Group<double>> groups = {Group<double>(RandomFlock("", 300, {2, 2, 2}, 51), 0.1)};
  const auto nearest = [&groups] {
    double least = 1e9;
    for (std::size_t i = 0; i < groups[0].x.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        least = std::min(least, Norm(groups[0].At(i) - groups[0].At(j)));
      }
    }
    return least;
  };
  EXPECT_LT(nearest(), 0.1);
  for (int k = 0; k < 100; ++k) Enforce(&groups);
  EXPECT_GT(nearest(), 0.199);
}

TEST(MinimumDistance, SameBytesAtAnyNumberOfThreads) {
  std::vector<Group<float>> one = {Group<float>(RandomFlock("", 9000, {9, 8, 7}, 61), 0.1),
                                   Group<float>(RandomFlock("", 3000, {9, 8, 7}, 62), 0.2)};
  auto two = one, four = one;
  for (int step = 0; step < 3; ++step) {
    const std::int64_t touched = Enforce(&one, 1);
    EXPECT_GT(touched, 1000);
    EXPECT_EQ(Enforce(&two, 2), touched);
    EXPECT_EQ(Enforce(&four, 4), touched);
  }
  for (std::size_t g = 0; g < one.size(); ++g) {
    EXPECT_EQ(one[g].x, two[g].x);
    EXPECT_EQ(one[g].y, two[g].y);
    EXPECT_EQ(one[g].z, four[g].z);
  }
}

// Few in a wide box are found another way. Everybody is in contact with several, whom other threads
// look up: what adds up in another order is rounded otherwise.
TEST(MinimumDistance, SameBytesOfKnotsFarApart) {
  constexpr int kKnots = 1500, kInEach = 6;
  const NamedFlock knots = RandomFlock("", kKnots, {200, 200, 200}, 63);
  NamedFlock flock = RandomFlock("", kKnots * kInEach + 5, {0.3, 0.3, 0.3}, 64);
  for (std::size_t k = 0; k < flock.position.size(); ++k) {
    flock.position[k] += knots.position[k % kKnots];
  }
  for (const int threads : {2, 3, 4}) {
    std::vector<Group<float>> one = {Group<float>(flock, 0.1)}, other = one;
    MinimumDistance<float> kept;
    ThreadPool pool(threads);
    for (int step = 0; step < 4; ++step) {
      const std::int64_t touched = Enforce(&one, 1);
      EXPECT_GT(touched, 3000);
      const Crowd<float> crowd = other[0].AsCrowd();
      EXPECT_EQ(kept.Enforce({&crowd, 1}, &pool), touched);
    }
    EXPECT_EQ(one[0].x, other[0].x) << threads;
    EXPECT_EQ(one[0].y, other[0].y) << threads;
    EXPECT_EQ(one[0].z, other[0].z) << threads;
  }
}

TEST(MinimumDistance, NothingToDo) {
  std::vector<Group<float>> nobody, alone = {Group<float>(RandomFlock("", 1, {1, 1, 1}, 1), 1)},
                                    roomless = {Group<float>(RandomFlock("", 9, {0, 0, 0}, 1), 0)};
  EXPECT_EQ(Enforce(&nobody), 0);
  EXPECT_EQ(Enforce(&alone), 0);
  EXPECT_EQ(Enforce(&roomless), 0);
}

}  // namespace
}  // namespace flocklift
