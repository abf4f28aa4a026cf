// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/window_store.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "reconstruct/solve/dynamics.h"
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
    knowledge_.up_in_cam = camera_.cam_from_world->rotation * Vec3d{0, 0, 1};
    options_.window = 2;
    options_.overlap = 0.5;
  }
  ~WindowStoreTest() override { fs::remove(path_); }

  BatchResult Solve(const fs::path& checkpoint, const Progress& progress) const {
    return SolveBatch(options_, knowledge_, segments_, flock_.fps, 1, progress, checkpoint);
  }
  BatchResult SolveWithForces(const fs::path& checkpoint, const Progress& progress) const {
    return SolveDynamics(dynamics_, options_, knowledge_, segments_, flock_.fps, 1, progress,
                         checkpoint);
  }

  // Boxes that change their form: later windows need the first one's body (body_fit.h).
  Tracks Beating() const {
    Tracks tracks = Observe(flock_, {}, CirclingFlock(flock_), camera_);
    for (Tracklet& tracklet : tracks.tracklets) {
      for (Detection& d : tracklet.detections) {
        const double stretch = std::exp(0.3 * std::sin(1.7 * d.frame));
        d.box = Box::Around(d.box.Center(), d.box.width / stretch, d.box.height * stretch);
      }
    }
    return tracks;
  }

  const fs::path path_ = fs::path(testing::TempDir()) / "window_store_test";
  FlockSpec flock_{.count = 3, .frames = 300};  // 10 s: five windows
  Camera camera_ = WatchingCamera();
  Segments segments_ = MakeSegments({}, Beating(), camera_, flock_.fps);
  Knowledge knowledge_;
  BatchOptions options_;
  DynamicsOptions dynamics_{.hidden = 0.5, .hidden_time = 0.4, .rounds = 1};
};

struct Kill {};
// Kills what reports when it is more than so far.
Progress KilledAt(double share) {
  return [share](std::int64_t done, std::int64_t total) {
    if (static_cast<double>(done) > share * static_cast<double>(total)) throw Kill();
  };
}

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
  const DynamicsReport &d = a.report.dynamics, &e = b.report.dynamics;
  EXPECT_EQ(d.windows, e.windows);
  EXPECT_EQ(d.kept, e.kept);
  EXPECT_EQ(d.hidden, e.hidden);
  EXPECT_EQ(d.weight, e.weight);
  EXPECT_EQ(d.batch_error, e.batch_error);
  EXPECT_EQ(d.dynamics_error, e.dynamics_error);
  EXPECT_EQ(d.forces, e.forces);
}

TEST_F(WindowStoreTest, AKilledRunGoesOnToTheSameBytes) {
  long whole_steps = 0, rest_steps = 0;
  const BatchResult whole = Solve({}, [&](auto, auto) { ++whole_steps; });
  EXPECT_FALSE(fs::exists(path_));
  EXPECT_THROW(Solve(path_, KilledAt(0.5)), Kill);
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

// What is said of forces is kept too. The first three windows of five are not solved again.
TEST_F(WindowStoreTest, AKilledRunWithForcesGoesOnToTheSameBytes) {
  std::int64_t first = -1;
  const BatchResult whole = SolveWithForces({}, {});
  EXPECT_EQ(whole.report.dynamics.windows, 5);
  EXPECT_GT(whole.report.dynamics.kept, 0);
  EXPECT_THROW(SolveWithForces(path_, KilledAt(0.605)), Kill);
  ASSERT_TRUE(fs::exists(path_));
  std::int64_t of = 0;
  const BatchResult resumed = SolveWithForces(path_, [&](std::int64_t done, std::int64_t total) {
    if (first < 0) first = done;
    of = total;
  });
  ExpectSame(resumed, whole);
  EXPECT_EQ(first, of / 5 * 3);
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(WindowStoreTest, WindowsOfAnotherMethodOrOfOtherForcesAreNotTaken) {
  const BatchResult whole = SolveWithForces({}, {});
  EXPECT_THROW(Solve(path_, KilledAt(0.5)), Kill);
  ASSERT_TRUE(fs::exists(path_));
  ExpectSame(SolveWithForces(path_, {}), whole);
  dynamics_.noise_sd *= 2;
  EXPECT_THROW(SolveWithForces(path_, KilledAt(0.5)), Kill);
  dynamics_.noise_sd /= 2;
  std::int64_t first = -1;
  ExpectSame(SolveWithForces(path_,
                             [&](std::int64_t done, std::int64_t) {
                               if (first < 0) first = done;
                             }),
             whole);
  EXPECT_EQ(first, 0);
}

TEST_F(WindowStoreTest, AnotherProblemStartsAnew) {
  constexpr std::uint64_t print = 5, changed = 6;
  SolvedWindow solved;
  solved.result.paths = {SolvedPath(7)};
  WindowStore(path_, print).Keep(3, solved);
  EXPECT_TRUE(WindowStore(path_, print).Find(3).has_value());
  EXPECT_EQ(WindowStore(path_, print).Find(3)->result.paths[0].size(), 7u);
  EXPECT_FALSE(WindowStore(path_, print).Find(2).has_value());
  EXPECT_FALSE(WindowStore(path_, changed).Find(3).has_value());
  EXPECT_FALSE(WindowStore(path_, print).Find(3).has_value());  // it is gone
}

TEST_F(WindowStoreTest, KeepsWhatIsKnownOfBodies) {
  SolvedWindow solved;
  solved.belief.body = {.image = BodyImage(BodyImage::Kind::kSilhouette, {.trunk = 0.2}),
                        .lean = 0.4,
                        .share = 0.9,
                        .weak_perspective = true};
  solved.result.report.weak_perspective = true;
  WindowStore(path_, 5).Keep(0, solved);
  const auto found = WindowStore(path_, 5).Find(0);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->belief.body.image.kind(), BodyImage::Kind::kSilhouette);
  EXPECT_EQ(found->belief.body.image.shape().trunk, 0.2);
  EXPECT_EQ(found->belief.body.lean, 0.4);
  EXPECT_NEAR(found->belief.body.Perspective(), 0.1, 1e-12);
  EXPECT_TRUE(found->result.report.weak_perspective);
}

TEST_F(WindowStoreTest, AFolderThatCannotBeMadeIsAnError) {
  EXPECT_THROW(WindowStore("/proc/nowhere/windows", 1), std::exception);
}

}  // namespace
}  // namespace flocklift
