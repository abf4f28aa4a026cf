// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/fingerprint.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

using internal::FingerprintOf;

TEST(Fingerprint, IsOfAllThatASolutionDependsOn) {
  const FlockSpec flock{.count = 3, .frames = 20};
  const Camera camera = WatchingCamera();
  Segments segments =
      MakeSegments({}, Observe(flock, {}, CirclingFlock(flock), camera), camera, 30);
  Knowledge knowledge;
  knowledge.wingspan = Uncertain{0.6, 0.03};
  BatchOptions options;
  const auto print = [&] { return FingerprintOf(options, knowledge, segments, 30); };
  EXPECT_EQ(print(), print());
  std::set<std::uint64_t> prints = {print(), FingerprintOf(options, knowledge, segments, 25),
                                    FingerprintOf(options, knowledge, segments, 30, 1),
                                    FingerprintOf(options, knowledge, segments, 30, 2)};
  EXPECT_EQ(prints.size(), 4U);
  const auto expect_new = [&](const char* what) {
    EXPECT_TRUE(prints.insert(print()).second) << what;
  };
  knowledge.wingspan->sd = 0.04;
  expect_new("knowledge");
  knowledge.speed = Uncertain{10, 1};
  expect_new("more knowledge");
  segments.segments[1].sightings[5].ray.x += 1e-9;
  expect_new("a sighting");
  segments.form.sd += 1e-9;
  expect_new("the form of boxes");
  options.overlap = 2;
  expect_new("an option");
}

}  // namespace
}  // namespace flocklift
