// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/scene_checkpoint.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "simulate/flock/simulate_scene.h"
#include "simulate/shapes/solid_meshes.h"

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

// A cube of tetrahedra that becomes another.
Scene MorphingScene(const fs::path& folder) {
  fs::create_directories(folder);
  std::ofstream mesh(folder / "cube.obj");
  const TriangleMesh cube = BoxMesh({-1, -1, -1}, {1, 1, 1});
  for (const Vec3d& v : cube.vertices) mesh << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
  for (const auto& t : cube.triangles) {
    mesh << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
  mesh.close();
  Scene scene;
  scene.fps = 20;
  scene.substeps = 2;
  scene.duration = 2;
  SpeciesSpec species;
  species.count = 40;
  species.model.name = "morph";
  species.model.parameters = {{"departure_time", 0.5}, {"d_min", 0.05}};
  species.start_shape = "here";
  species.shape = "there";
  scene.species = {species};
  for (const auto& [name, x] : {std::pair("here", 0.0), std::pair("there", 12.0)}) {
    ShapeSpec shape;
    shape.name = name;
    shape.key_frames = {{folder / "cube.obj", 0}};
    shape.placement.position = {x, 0, 0};
    scene.shapes.push_back(shape);
  }
  return scene;
}

TEST(SceneCheckpoint, AKilledMorphEndsWithTheSameMesh) {
  const Folder folder;
  const Scene scene = MorphingScene(folder.path / "meshes");
  const fs::path checkpoint = folder.path / "checkpoint", mesh = folder.path / "mesh.glb";
  const auto bytes = [](const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  SimulateOptions options{.threads = 1,
                          .checkpoint = {},
                          .checkpoint_every = std::chrono::seconds(0),
                          .tetrahedra = folder.path / "whole.glb"};
  const SceneResult whole = SimulateScene(scene, options, {});
  options.checkpoint = checkpoint;
  options.tetrahedra = mesh;
  const auto stop = [](std::int64_t done, std::int64_t total) {
    if (done > total / 2) throw std::runtime_error("killed");
  };
  EXPECT_THROW(SimulateScene(scene, options, stop), std::runtime_error);
  EXPECT_FALSE(fs::exists(mesh));
  std::ofstream(checkpoint / "corners", std::ios::app | std::ios::binary) << "half a frame";
  std::int64_t first = -1;
  const SceneResult resumed = SimulateScene(
      scene, options,
      [&first](std::int64_t done, std::int64_t) { first = first < 0 ? done : first; });
  EXPECT_GT(first, 15);  // it did not start again
  ExpectSame(resumed.truth, whole.truth);
  EXPECT_EQ(bytes(mesh), bytes(folder.path / "whole.glb"));
  EXPECT_FALSE(fs::exists(checkpoint));
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
