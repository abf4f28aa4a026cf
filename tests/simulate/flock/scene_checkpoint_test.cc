// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/scene_checkpoint.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "simulate/flock/simulate_scene.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

Scene SmallScene() {
  Scene scene;
  scene.duration = 1;
  scene.warmup = 0.2;
  SpeciesSpec species;
  species.count = 20;
  scene.species = {species};
  scene.predators = {PredatorSpec{.count = 2}};
  scene.wind = {.velocity = {1, 0, 0}, .gust = 1, .gust_time = 0.5};
  return scene;
}

// A folder that is gone when the test ends.
struct Folder {
  fs::path path = fs::temp_directory_path() /
                  ("flocklift_checkpoint_" +
                   std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
  Folder() { fs::remove_all(path); }
  ~Folder() { fs::remove_all(path); }
};

void ExpectSame(const Trajectories& a, const Trajectories& b) {
  ASSERT_EQ(a.trajectories.size(), b.trajectories.size());
  for (std::size_t k = 0; k < a.trajectories.size(); ++k) {
    const auto &p = a.trajectories[k].points, &q = b.trajectories[k].points;
    ASSERT_EQ(p.size(), q.size());
    for (std::size_t f = 0; f < p.size(); ++f) {
      EXPECT_EQ(p[f].frame, q[f].frame);
      EXPECT_EQ(p[f].position, q[f].position);
      EXPECT_EQ(p[f].velocity, q[f].velocity);
    }
  }
}

// Runs the scene and stops in the middle, as if killed.
void KilledRun(const Scene& scene, const fs::path& folder) {
  const auto stop = [](std::int64_t done, std::int64_t total) {
    if (done > total / 2) throw std::runtime_error("killed");
  };
  EXPECT_THROW(
      SimulateScene(scene, {.threads = 1, .checkpoint = folder, .checkpoint_every = {}}, stop),
      std::runtime_error);
  EXPECT_TRUE(fs::exists(folder / "state"));
}

TEST(SceneCheckpoint, AKilledRunEndsWithTheSameBytes) {
  const Folder folder;
  const Scene scene = SmallScene();
  KilledRun(scene, folder.path);
  std::int64_t first = -1;
  const SceneResult resumed = SimulateScene(
      scene, {.threads = 2, .checkpoint = folder.path},
      [&first](std::int64_t done, std::int64_t) { first = first < 0 ? done : first; });
  EXPECT_GT(first, 15);  // it did not start again
  const SceneResult whole = SimulateScene(scene, {}, {});
  ExpectSame(resumed.truth, whole.truth);
  EXPECT_EQ(resumed.steps, whole.steps);
  EXPECT_EQ(resumed.mean_neighbours, whole.mean_neighbours);
  EXPECT_FALSE(fs::exists(folder.path));
}

TEST(SceneCheckpoint, FramesAfterTheStateAreCutOff) {
  const Folder folder;
  const Scene scene = SmallScene();
  KilledRun(scene, folder.path);
  std::ofstream(folder.path / "frames", std::ios::app | std::ios::binary) << "half a frame";
  ExpectSame(SimulateScene(scene, {.threads = 1, .checkpoint = folder.path}, {}).truth,
             SimulateScene(scene, {}, {}).truth);
}

TEST(SceneCheckpoint, AnotherScenesIsIgnored) {
  const Folder folder;
  Scene scene = SmallScene();
  KilledRun(scene, folder.path);
  ++scene.seed;
  ExpectSame(SimulateScene(scene, {.threads = 1, .checkpoint = folder.path}, {}).truth,
             SimulateScene(scene, {}, {}).truth);
}

}  // namespace
}  // namespace flocklift
