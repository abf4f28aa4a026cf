// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/replay/replay_flight.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "reconstruct/replay/guided_flight.h"

namespace flocklift {
namespace {

constexpr int kMatched = 12;  // frames, about, that paths are compared in

class FreeFlight final : public ReplayFlight {
 public:
  FreeFlight(const std::vector<Id>& ids, Engine engine, std::vector<std::size_t> place,
             int substeps)
      : ids_(ids), engine_(std::move(engine)), place_(std::move(place)), substeps_(substeps) {}

  FlockState NextFrame() override {
    for (int step = 0; step < substeps_; ++step) engine_.Step();
    return Now();
  }
  FlockState Now() const {
    const FlockState all = engine_.State();
    FlockState state{.id = ids_, .position = {}, .velocity = {}};
    for (const std::size_t k : place_) {
      state.position.push_back(all.position[k]);
      state.velocity.push_back(all.velocity[k]);
    }
    return state;
  }

 private:
  std::vector<Id> ids_;
  Engine engine_;
  std::vector<std::size_t> place_;  // of each animal in the engine
  int substeps_;
};

class PulledFlight final : public ReplayFlight {
 public:
  PulledFlight(GuidedFlight flight, int substeps, const Trajectories& reconstruction,
               const ReplayStart& start, double fps)
      : flight_(std::move(flight)),
        reconstruction_(reconstruction),
        start_(start),
        frame_(start.frame),
        substeps_(substeps),
        fps_(fps) {}

  FlockState NextFrame() override {
    const FlockState now = StateAtFrame(reconstruction_, frame_);
    const FlockState next = StateAtFrame(reconstruction_, ++frame_);
    std::unordered_map<Id, std::size_t> now_index, next_index;
    for (std::size_t k = 0; k < now.size(); ++k) now_index.emplace(now.id[k], k);
    for (std::size_t k = 0; k < next.size(); ++k) next_index.emplace(next.id[k], k);
    std::vector<std::optional<PathPoint>> paths(start_.id.size());
    for (int step = 0; step < substeps_; ++step) {
      const double u = static_cast<double>(step) / substeps_;
      for (std::size_t k = 0; k < paths.size(); ++k) {
        const auto a = now_index.find(start_.source[k]), b = next_index.find(start_.source[k]);
        paths[k].reset();
        if (a == now_index.end() || b == next_index.end()) continue;
        const Vec3d& from = now.position[a->second];
        const Vec3d& to = next.position[b->second];
        paths[k] = PathPoint{from + u * (to - from) + start_.offset[k], (to - from) * fps_};
      }
      flight_.Step(paths, 1 / (fps_ * substeps_));
    }
    return {start_.id, flight_.position(), flight_.velocity()};
  }

 private:
  GuidedFlight flight_;
  const Trajectories& reconstruction_;
  const ReplayStart& start_;
  int frame_, substeps_;
  double fps_;
};

}  // namespace

std::unique_ptr<ReplayFlight> FlyFreely(const std::vector<Id>& ids, const Departure& from,
                                        int substeps, int threads) {
  return std::make_unique<FreeFlight>(
      ids, Engine(from.world, {from.swarm}, {.threads = threads, .kernel = {}}), from.place,
      substeps);
}

std::unique_ptr<ReplayFlight> FlyPulled(const Parameters& parameters,
                                        const TermSurroundings& around, double alpha,
                                        double pull_time, int substeps,
                                        const Trajectories& reconstruction,
                                        const ReplayStart& start, double fps) {
  return std::make_unique<PulledFlight>(GuidedFlight(parameters, alpha, pull_time, start.position,
                                                     start.velocity, start.cruising_speed, around),
                                        substeps, reconstruction, start, fps);
}

std::unique_ptr<ReplayFlight> FlyFromSceneStart(const Departures& departures, std::uint64_t seed,
                                                int threads, const Trajectories& reconstruction,
                                                double fps, ReplayStart* start) {
  World world = departures.world();
  world.seed = seed;
  Engine engine(world, {departures.swarm()}, {.threads = threads, .kernel = {}});
  const std::size_t count = departures.swarm().position.size();
  const int first = std::min(SpanOf(reconstruction).first, start->frame);
  const int stride = std::max(1, (start->frame - first) / kMatched);
  std::vector<FramePositions> seen;
  std::vector<std::vector<Vec3d>> flown;
  std::int64_t steps = 0;
  for (int frame = first; frame <= start->frame; ++frame) {
    const double time = (frame - 1) / fps - world.time;
    for (; steps < std::llround(time / world.dt); ++steps) engine.Step();
    if ((start->frame - frame) % stride != 0) continue;
    FlockState here = StateAtFrame(reconstruction, frame);
    seen.push_back({std::move(here.id), std::move(here.position)});
    flown.push_back(engine.State().position);
    flown.back().resize(count);
  }
  std::vector<std::size_t> place = NearestPaths(start->id, seen, flown);
  auto flight = std::make_unique<FreeFlight>(start->id, std::move(engine), std::move(place),
                                             departures.substeps());
  const FlockState now = flight->Now();
  start->position = now.position;
  start->velocity = now.velocity;
  return flight;
}

}  // namespace flocklift
