// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/window_store.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

using namespace internal;  // NOLINT: the parts under test
namespace fs = std::filesystem;

class WindowStoreTest : public testing::Test {
 protected:
  WindowStoreTest() {
    fs::remove(path_);
    knowledge_.speed = Uncertain{10, 1};
    knowledge_.wingspan = Uncertain{0.6, 0.03};
    options_.window = 2;
    options_.overlap = 0.5;
  }
  ~WindowStoreTest() override { fs::remove(path_); }

  BatchResult Solve(const fs::path& checkpoint, const Progress& progress) const {
    return SolveBatch(options_, knowledge_, segments_, flock_.fps, 1, progress, checkpoint);
  }

  const fs::path path_ = fs::path(testing::TempDir()) / "window_store_test";
  FlockSpec flock_{.count = 3, .frames = 300};  // 10 s: five windows
  Camera camera_ = WatchingCamera();
  Segments segments_ =
      MakeSegments({}, Observe(flock_, {}, CirclingFlock(flock_), camera_), camera_, flock_.fps);
  Knowledge knowledge_;
  BatchOptions options_;
};

void ExpectSame(const BatchResult& a, const BatchResult& b) {
  ASSERT_EQ(a.paths.size(), b.paths.size());
  for (std::size_t i = 0; i < a.paths.size(); ++i) {
    ASSERT_EQ(a.paths[i].size(), b.paths[i].size());
    EXPECT_EQ(
        std::memcmp(a.paths[i].data(), b.paths[i].data(), a.paths[i].size() * sizeof(SolvedPoint)),
        0);
  }
  EXPECT_EQ(a.report.final_cost, b.report.final_cost);
  EXPECT_EQ(a.report.iterations, b.report.iterations);
  EXPECT_EQ(a.report.lean.mean, b.report.lean.mean);
  EXPECT_EQ(a.report.spreads, b.report.spreads);
  ASSERT_EQ(a.report.terms.size(), b.report.terms.size());
  for (std::size_t k = 0; k < a.report.terms.size(); ++k) {
    EXPECT_EQ(a.report.terms[k].name, b.report.terms[k].name);
    EXPECT_EQ(a.report.terms[k].count, b.report.terms[k].count);
    EXPECT_EQ(a.report.terms[k].rms, b.report.terms[k].rms);
  }
}

TEST_F(WindowStoreTest, AKilledRunGoesOnToTheSameBytes) {
  long whole_steps = 0, rest_steps = 0;
  const BatchResult whole = Solve({}, [&](auto, auto) { ++whole_steps; });
  EXPECT_FALSE(fs::exists(path_));
  struct Kill {};
  EXPECT_THROW(Solve(path_,
                     [&](std::int64_t done, std::int64_t total) {
                       if (done > total / 2) throw Kill();
                     }),
               Kill);
  ASSERT_TRUE(fs::exists(path_));
  // The kill came in the middle of a write.
  const std::uintmax_t size = fs::file_size(path_);
  std::ofstream(path_, std::ios::binary | std::ios::app) << std::string(100, 'x');
  ASSERT_EQ(fs::file_size(path_), size + 100);
  const BatchResult resumed = Solve(path_, [&](auto, auto) { ++rest_steps; });
  ExpectSame(resumed, whole);
  EXPECT_LT(rest_steps, 0.7 * whole_steps);
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(WindowStoreTest, AnotherProblemStartsAnew) {
  const std::uint64_t print = FingerprintOf(options_, knowledge_, segments_, 30);
  SolvedWindow solved;
  solved.result.paths = {SolvedPath(7)};
  WindowStore(path_, print).Keep(3, solved);
  EXPECT_TRUE(WindowStore(path_, print).Find(3).has_value());
  EXPECT_EQ(WindowStore(path_, print).Find(3)->result.paths[0].size(), 7u);
  EXPECT_FALSE(WindowStore(path_, print).Find(2).has_value());
  Knowledge other = knowledge_;
  other.wingspan->sd = 0.04;
  const std::uint64_t changed = FingerprintOf(options_, other, segments_, 30);
  EXPECT_NE(changed, print);
  EXPECT_FALSE(WindowStore(path_, changed).Find(3).has_value());
  EXPECT_FALSE(WindowStore(path_, print).Find(3).has_value());  // it is gone
  segments_.segments[1].sightings[5].ray.x += 1e-9;
  EXPECT_NE(FingerprintOf(options_, knowledge_, segments_, 30), print);
}

TEST_F(WindowStoreTest, AFolderThatCannotBeMadeIsAnError) {
  EXPECT_THROW(WindowStore("/proc/nowhere/windows", 1), std::exception);
}

}  // namespace
}  // namespace flocklift
