// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a killed simulation goes on from: a folder with the frames so far (`frames`, appended to)
// and the engine's state after the last of them (`state`, replaced as a whole). Where tetrahedra
// are written as a mesh, their corners are kept too (`corners`, appended to at every frame, 12
// bytes a corner). A state that is not of this scene and program is ignored, and a frame that was
// written after it is cut off.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SCENE_CHECKPOINT_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SCENE_CHECKPOINT_H_

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "simulate/core/scene.h"
#include "simulate/core/trajectory.h"
#include "simulate/flock/engine.h"
#include "simulate/shapes/animated_mesh_writer.h"

namespace flocklift {

class SceneCheckpoint {
 public:
  // An empty folder name keeps nothing.
  SceneCheckpoint(std::filesystem::path folder, std::chrono::seconds every, const Scene& scene);

  // Sets all to where the checkpoint stands, the frame to the next one to record; leaves them alone
  // when there is no checkpoint of this scene. `tetrahedra`, null for none, gets the frames so far,
  // of so many corners.
  void Resume(Engine* engine, std::int64_t* frame, Trajectories* truth,
              AnimatedMeshWriter* tetrahedra, std::size_t corners);

  // Of the frame that was just recorded [m].
  void AddCorners(std::span<const Vec3<float>> corners);

  // Whether the last state that was kept is old enough for another one.
  bool Due() const;

  // After `frame` was recorded and the engine took its steps: keeps the state. Throws
  // std::runtime_error when it cannot be written.
  void Keep(const Engine& engine, std::int64_t frame, const Trajectories& truth);

  // The run is over.
  void Remove();

 private:
  std::filesystem::path folder_;
  std::chrono::steady_clock::duration every_;
  std::chrono::steady_clock::time_point last_;
  std::string fingerprint_;      // of scene and program
  std::size_t kept_frames_ = 0;  // that stand in `frames`
  std::ofstream corners_;        // open from the first frame of this run on
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SCENE_CHECKPOINT_H_
