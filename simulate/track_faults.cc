// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/track_faults.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr std::uint64_t kGapStream = std::uint64_t{0x676170} << 40;
constexpr std::uint64_t kDriftStream = std::uint64_t{0x647269} << 40;
constexpr std::uint64_t kSwitchStream = std::uint64_t{0x737769} << 40;

Rng StreamOf(std::uint64_t stream, std::uint64_t seed, Id id, int frame) {
  return Rng(seed, stream | static_cast<std::uint64_t>(id), static_cast<std::uint32_t>(frame));
}

Detection Resized(const Detection& seen, double scale) {
  Detection resized = seen;
  resized.box = Box::Around(seen.box.Center(), scale * seen.box.width, scale * seen.box.height);
  if (resized.shape) {
    resized.shape->major *= scale;
    resized.shape->minor *= scale;
    resized.shape->area *= scale * scale;
  }
  return resized;
}

// The rows of `paths` (tracklets or trajectories) sorted by the names that their animals have.
template <typename Path, typename Rows>
std::vector<Path> Renamed(std::span<const IdentitySwitch> switches, const std::vector<Path>& paths,
                          Rows Path::*rows) {
  // The name of every animal from which frame on.
  std::map<Id, std::vector<std::pair<int, Id>>> names;
  const auto name_of = [&](Id animal) {
    const auto found = names.find(animal);
    return found == names.end() ? animal : found->second.back().second;
  };
  for (const IdentitySwitch& s : switches) {
    const Id of_a = name_of(s.a), of_b = name_of(s.b);
    names[s.a].emplace_back(s.frame, of_b);
    names[s.b].emplace_back(s.frame, of_a);
  }
  std::map<Id, Path> by_name;
  for (const Path& path : paths) {
    const auto found = names.find(path.id);
    std::size_t next = 0;
    Id name = path.id;
    for (const auto& row : path.*rows) {
      if (found != names.end()) {
        const auto& changes = found->second;
        for (; next < changes.size() && changes[next].first <= row.frame; ++next) {
          name = changes[next].second;
        }
      }
      Path& to = by_name[name];
      to.id = name;
      (to.*rows).push_back(row);
    }
  }
  std::vector<Path> renamed;
  for (auto& [name, path] : by_name) {
    std::sort((path.*rows).begin(), (path.*rows).end(),
              [](const auto& a, const auto& b) { return a.frame < b.frame; });
    renamed.push_back(std::move(path));
  }
  return renamed;
}

}  // namespace

Tracks SynthesizeFaults(const TrackFaults& faults, std::uint64_t seed, double fps,
                        const Tracks& tracks) {
  CheckOptions(faults);
  Check(fps > 0, "fps must be positive");
  Tracks result{.fps = tracks.fps, .tracklets = {}};
  for (const Tracklet& truth : tracks.tracklets) {
    Tracklet tracklet{.id = truth.id, .detections = {}};
    double drift = 0, last_time = -std::numeric_limits<double>::infinity(), lost_until = 0;
    for (const Detection& seen : truth.detections) {
      Rng gap = StreamOf(kGapStream, seed, truth.id, seen.frame);
      const bool begins = gap.Uniform() < faults.gaps / 1000;
      const double length = 1 - faults.gap_length * std::log(1 - gap.Uniform());
      const double time = seen.frame / fps;
      const double rho = std::exp(-(time - last_time) / faults.size_drift_time);
      last_time = time;
      drift = rho * drift + faults.size_drift_sd * std::sqrt(1 - rho * rho) *
                                StreamOf(kDriftStream, seed, truth.id, seen.frame).Normal();
      if (begins) lost_until = std::max(lost_until, seen.frame + std::floor(length));
      if (seen.frame < lost_until) continue;
      tracklet.detections.push_back(Resized(seen, std::exp(drift)));
    }
    if (!tracklet.detections.empty()) result.tracklets.push_back(std::move(tracklet));
  }
  return result;
}

std::vector<IdentitySwitch> SynthesizeSwitches(const TrackFaults& faults, std::uint64_t seed,
                                               const Tracks& tracks) {
  CheckOptions(faults);
  struct Place {
    Id id;
    Vec2d center;
  };
  std::map<int, std::vector<Place>> frames;
  for (const Tracklet& tracklet : tracks.tracklets) {
    for (const Detection& seen : tracklet.detections) {
      frames[seen.frame].push_back({tracklet.id, seen.box.Center()});
    }
  }
  std::vector<IdentitySwitch> switches;
  for (const auto& [frame, places] : frames) {
    if (places.size() < 2) continue;
    for (const Place& place : places) {
      if (StreamOf(kSwitchStream, seed, place.id, frame).Uniform() >= faults.switches / 1000) {
        continue;
      }
      const auto away = [&](const Place& other) {
        return other.id == place.id
                   ? std::numeric_limits<double>::infinity()
                   : std::hypot(other.center.x - place.center.x, other.center.y - place.center.y);
      };
      const auto nearest =
          std::min_element(places.begin(), places.end(),
                           [&](const Place& a, const Place& b) { return away(a) < away(b); });
      switches.push_back({frame, place.id, nearest->id});
    }
  }
  return switches;
}

Tracks WithSwitches(std::span<const IdentitySwitch> switches, const Tracks& tracks) {
  return {.fps = tracks.fps,
          .tracklets = Renamed(switches, tracks.tracklets, &Tracklet::detections)};
}

Trajectories WithSwitches(std::span<const IdentitySwitch> switches,
                          const Trajectories& trajectories) {
  Trajectories renamed = trajectories;
  renamed.trajectories = Renamed(switches, trajectories.trajectories, &Trajectory::points);
  return renamed;
}

}  // namespace flocklift
