// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A scene that runs while somebody steers it: the engine on a thread of its own, 60 looks a second
// at the pace of real time or as many steps as it manages, and changes between two steps.
//
// What the engine cannot change in flight (a new goal) is done by making it anew from where
// everybody is: noise starts afresh then, animals do not.

#ifndef FLOCKLIFT_TOOLS_VIEW_LIVE_SCENE_H_
#define FLOCKLIFT_TOOLS_VIEW_LIVE_SCENE_H_

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "simulate/core/scene.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/population.h"

namespace flocklift {

class LiveScene {
 public:
  // Throws as Populate and Engine do. Starts to run.
  LiveScene(const Scene& scene, int threads);
  ~LiveScene();
  LiveScene(const LiveScene&) = delete;
  LiveScene& operator=(const LiveScene&) = delete;

  // Each waits until it is done, and throws std::invalid_argument or InputError, with nothing
  // changed, when it cannot be.
  void Pause(bool paused);
  void StepOnce();
  void Reset();               // to the scene's start, with the parameters as they are
  void SetPace(double pace);  // of real time, 0.05 to 20
  void SetParameter(const std::string& species, const ModelSpec& change);
  void MoveGoal(std::size_t index, const Vec3d& position);
  void MovePredator(std::size_t index, const Vec3d& position);
  void SetWind(const Vec3d& velocity);
  // A point that attracts everybody with `weight` [1/s^2]; none takes it away. Where animals go to
  // goals of their own (crowd, whose groups are made for them) or to the nearest (swarm), the first
  // goal moves there instead.
  void Attract(const std::optional<Vec3d>& position, double weight);
  // A goal that flies along a line from now on, over so many seconds; it attracts everybody.
  void Lead(const std::vector<Vec3d>& line, double seconds, double weight);
  // The line becomes a path of the scene, the guidance curve of what moves along it: that which
  // begins nearest to where the line begins. The scene starts anew.
  void Guide(const std::vector<Vec3d>& line);

  // The scene as it is now: parameters, goals and wind as steered. Where the animals are is not
  // part of a scene.
  Scene Current();

  // The last look (tools/view/scene_look.h) that is newer than `*seen`, which moves on; waits a
  // little for one, and may be null.
  std::shared_ptr<const std::string> Look(std::uint64_t* seen);

  std::size_t agents() const { return population_.animals.size(); }
  const Population& population() const { return population_; }

 private:
  void Work();
  void Do(const std::function<void()>& change);
  void Restart();  // from the scene's start
  void Rebuild();  // from where everybody is
  void MakeLook(double looks_per_second, double steps_per_second);

  Scene scene_;  // as steered
  int threads_;
  Population population_;  // at the start
  std::unique_ptr<Engine> engine_;
  std::optional<std::size_t> attraction_;  // its place among the goals
  bool paused_ = false;
  double pace_ = 1;
  std::uint64_t rebuilds_ = 0;

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  struct Change;
  std::vector<Change*> changes_;
  std::shared_ptr<const std::string> look_;
  std::uint64_t looks_ = 0;
  bool stops_ = false;
  std::thread thread_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_LIVE_SCENE_H_
