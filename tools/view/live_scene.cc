// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/live_scene.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/flock/model.h"
#include "tools/view/scene_look.h"

namespace flocklift {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLooksPerSecond = 60;
constexpr double kMostOfALook = 0.9;  // of its time may be stepping

double Seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

// What another thread wants done, and how it went.
struct LiveScene::Change {
  const std::function<void()>& work;
  bool done = false;
  std::exception_ptr error = {};
};

LiveScene::LiveScene(const Scene& scene, int threads)
    : scene_(scene), threads_(threads), population_(Populate(scene)) {
  engine_ = std::make_unique<Engine>(population_.world, population_.swarms,
                                     EngineOptions{.threads = threads, .kernel = {}});
  MakeLook(0, 0);
  thread_ = std::thread([this] { Work(); });
}

LiveScene::~LiveScene() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LiveScene::Do(const std::function<void()>& work) {
  Change change{.work = work};
  std::unique_lock lock(mutex_);
  changes_.push_back(&change);
  changed_.notify_all();
  changed_.wait(lock, [&] { return change.done; });
  if (change.error) std::rethrow_exception(change.error);
}

void LiveScene::Work() {
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1 / kLooksPerSecond));
  auto next = Clock::now();
  double owed = 0;  // simulated time that is still to be stepped [s]
  auto counted = Clock::now();
  int looks = 0, steps = 0;
  double looks_per_second = 0, steps_per_second = 0;
  while (true) {
    bool changed = false;
    {
      std::unique_lock lock(mutex_);
      changed_.wait_until(lock, next, [this] { return stops_ || !changes_.empty(); });
      if (stops_) {
        for (Change* change : changes_) change->done = true;
        changed_.notify_all();
        return;
      }
      for (Change* change : std::exchange(changes_, {})) {
        try {
          change->work();
          changed = true;
        } catch (...) {
          change->error = std::current_exception();
        }
        change->done = true;
      }
      changed_.notify_all();
    }
    const auto start = Clock::now();
    if (start < next && !changed) continue;
    if (start >= next) {
      // A look that is late is not caught up with.
      next = std::max(next + period, start - period);
      if (!paused_) owed += pace_ / kLooksPerSecond;
      try {
        const double dt = population_.world.dt;
        while (!paused_ && owed >= dt &&
               Seconds(Clock::now() - start) < kMostOfALook / kLooksPerSecond) {
          engine_->Step();
          owed -= dt;
          ++steps;
        }
        owed = std::min(owed, 2 * dt + pace_ / kLooksPerSecond);
      } catch (const std::runtime_error&) {
        paused_ = true;  // the state is not finite any more: a reset helps
      }
      ++looks;
      if (const double seconds = Seconds(start - counted); seconds > 0.5) {
        looks_per_second = looks / seconds;
        steps_per_second = steps / seconds;
        looks = steps = 0;
        counted = start;
      }
    }
    MakeLook(looks_per_second, steps_per_second);
  }
}

void LiveScene::MakeLook(double looks_per_second, double steps_per_second) {
  std::vector<Vec3d> goals;
  for (const GoalSpec& goal : scene_.goals) goals.push_back(GoalPosition(goal, engine_->time()));
  auto look =
      std::make_shared<std::string>(PackLook(engine_->State(), goals,
                                             {.number = static_cast<std::uint32_t>(looks_ + 1),
                                              .time = engine_->time(),
                                              .looks_per_second = looks_per_second,
                                              .steps_per_second = steps_per_second}));
  {
    const std::lock_guard lock(mutex_);
    look_ = std::move(look);
    ++looks_;
  }
  changed_.notify_all();
}

std::shared_ptr<const std::string> LiveScene::Look(std::uint64_t* seen) {
  constexpr std::chrono::milliseconds kWait(200);
  std::unique_lock lock(mutex_);
  if (!changed_.wait_for(lock, kWait, [&] { return looks_ > *seen; })) return nullptr;
  *seen = looks_;
  return look_;
}

void LiveScene::Rebuild() {
  const FlockState state = engine_->State();
  Population now = population_;
  now.world.seed = scene_.seed + ++rebuilds_;
  now.world.time = engine_->time();
  now.world.goals = scene_.goals;
  now.world.wind = scene_.wind;
  std::erase_if(now.world.events,
                [&](const EventSpec& event) { return event.time <= now.world.time; });
  for (EventSpec& event : now.world.events) {
    if (event.goal && *event.goal > scene_.goals.size()) event.goal.reset();
  }
  std::size_t agent = 0;
  for (Swarm& swarm : now.swarms) {
    for (const SpeciesSpec& species : scene_.species) {
      if (species.name != swarm.species) continue;
      swarm.spec = species.model;
      swarm.model = ResolveModel(species.model);
      swarm.forces = species.forces;
    }
    for (std::size_t k = 0; k < swarm.position.size(); ++k, ++agent) {
      swarm.position[k] = state.position[agent];
      swarm.velocity[k] = state.velocity[agent];
    }
  }
  auto engine = std::make_unique<Engine>(now.world, now.swarms,
                                         EngineOptions{.threads = threads_, .kernel = {}});
  for (std::size_t k = 0; agent + k < state.size(); ++k) {
    engine->MovePredator(k, state.position[agent + k]);
  }
  engine_ = std::move(engine);
}

void LiveScene::Pause(bool paused) {
  Do([&] { paused_ = paused; });
}

void LiveScene::StepOnce() {
  Do([&] {
    paused_ = true;
    engine_->Step();
  });
}

void LiveScene::Restart() {
  Population start = Populate(scene_);
  engine_ = std::make_unique<Engine>(start.world, start.swarms,
                                     EngineOptions{.threads = threads_, .kernel = {}});
  population_ = std::move(start);
}

void LiveScene::Reset() {
  Do([&] { Restart(); });
}

void LiveScene::SetPace(double pace) {
  Check(pace >= 0.05 && pace <= 20, "the pace must be 0.05 to 20");
  Do([&] { pace_ = pace; });
}

Scene LiveScene::Current() {
  Scene scene;
  Do([&] { scene = scene_; });
  return scene;
}

}  // namespace flocklift
