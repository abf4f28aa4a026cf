// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/cobyla.h"

#include <algorithm>
#include <cmath>
#include <nlopt.hpp>

#include "reconstruct/solve/lin_objective.h"
#include "simulate/core/check.h"
#include "simulate/core/options.h"

namespace flocklift {
namespace internal {
namespace {

// The sum with the targets of frame f-1 at hand, which do not depend on the depths.
double Objective(const CobylaOptions& options, double fps, const std::vector<LinAnimal>& animals,
                 const std::vector<Vec3d>& targets, const double* depths) {
  std::vector<Vec3d> positions(animals.size());
  for (std::size_t n = 0; n < animals.size(); ++n) positions[n] = depths[n] * animals[n].ray;
  double sum = 0;
  for (std::size_t n = 0; n < animals.size(); ++n) {
    const LinAnimal& a = animals[n];
    const double displacement = Norm(positions[n] - a.last);
    if (a.solved_frames < 2) {
      sum += std::abs(displacement - options.lambda_speed / fps);
      continue;
    }
    const Vec3d target =
        options.current_frame ? LinTargetOf(options, positions, n, a.last) : targets[n];
    sum += options.lambda_t * std::abs(displacement - Norm(a.last - a.before_last)) +
           options.lambda_f * Norm(positions[n] - target);
  }
  return sum;
}

struct Problem {
  const CobylaOptions& options;
  double fps;
  const std::vector<LinAnimal>& animals;
  const std::vector<Vec3d>& targets;
};

double Evaluate(const std::vector<double>& x, std::vector<double>& /*gradient*/, void* data) {
  const Problem& p = *static_cast<const Problem*>(data);
  return Objective(p.options, p.fps, p.animals, p.targets, x.data());
}

}  // namespace

std::vector<Vec3d> LinTargetsOfLastFrame(const CobylaOptions& options,
                                         const std::vector<LinAnimal>& animals) {
  std::vector<Vec3d> last, targets;
  for (const LinAnimal& a : animals) last.push_back(a.last);
  for (std::size_t n = 0; n < animals.size(); ++n) {
    targets.push_back(LinTargetOf(options, last, n, last[n]));
  }
  return targets;
}

double LinObjective(const CobylaOptions& options, double fps, const std::vector<LinAnimal>& animals,
                    const std::vector<double>& depths) {
  return Objective(options, fps, animals, LinTargetsOfLastFrame(options, animals), depths.data());
}

double MinimizeLinByCobyla(const CobylaOptions& options, double fps,
                           const std::vector<LinAnimal>& animals, std::vector<double>* depths,
                           bool* exhausted) {
  const std::vector<Vec3d> targets = LinTargetsOfLastFrame(options, animals);
  Problem problem{options, fps, animals, targets};
  nlopt::opt solver(nlopt::LN_COBYLA, static_cast<unsigned>(animals.size()));
  solver.set_min_objective(Evaluate, &problem);
  solver.set_lower_bounds(options.near);
  solver.set_upper_bounds(options.far);
  solver.set_xtol_rel(options.tolerance);
  solver.set_maxeval(options.max_evaluations);
  // The first trust region: the farthest an animal may come in one frame.
  solver.set_initial_step(std::max(options.lambda_speed / fps, 1e-3 * options.near));
  double cost = 0;
  *exhausted = false;
  try {
    *exhausted = solver.optimize(*depths, cost) == nlopt::MAXEVAL_REACHED;
  } catch (const nlopt::roundoff_limited&) {
    // The depths are the best found.
    cost = Objective(options, fps, animals, targets, depths->data());
  }
  return cost;
}

}  // namespace internal

namespace {

using internal::LinAnimal;

struct Track {
  const Segment* segment = nullptr;
  std::size_t next = 0;  // its next sighting
  int solved_frames = 0;
  Vec3d last, before_last;
};

void FillVelocities(double fps, const Segment& segment, SolvedPath* path) {
  for (std::size_t k = 0; k < path->size(); ++k) {
    const std::size_t before = k > 0 ? k - 1 : k;
    const std::size_t after = k > 0 || path->size() == 1 ? k : k + 1;
    const int frames = segment.sightings[after].frame - segment.sightings[before].frame;
    if (frames > 0) {
      (*path)[k].velocity_in_cam =
          ((*path)[after].position_in_cam - (*path)[before].position_in_cam) * (fps / frames);
    }
  }
}

}  // namespace

CobylaResult SolveCobyla(const CobylaOptions& options, const FirstDepths& first_depths,
                         const Segments& segments, double fps, const Progress& progress,
                         LinOptimizer optimizer) {
  CheckOptions(options);
  Check(options.near > 0 && options.near < options.far,
        "d-near must be positive and less than d-far");
  CobylaResult result;
  std::vector<Track> tracks;
  int first = 0, last = -1;
  for (const Segment& segment : segments.segments) {
    tracks.push_back({.segment = &segment, .last = {}, .before_last = {}});
    if (last < first) first = segment.sightings.front().frame;
    first = std::min(first, segment.sightings.front().frame);
    last = std::max(last, segment.sightings.back().frame);
  }
  result.paths.resize(tracks.size());
  double mean_depth = 0.5 * (options.near + options.far);
  for (int frame = first; frame <= last; ++frame) {
    Report(progress, frame - first, last - first + 1);
    std::vector<std::size_t> there;
    std::vector<LinAnimal> animals;
    std::vector<double> depths;
    double sum = 0, count = 0;
    const auto take = [&](std::size_t i, const Vec3d& position) {
      Track& track = tracks[i];
      track.before_last = track.last;
      track.last = position;
      ++track.solved_frames;
      ++track.next;
      sum += position.z;
      count += 1;
      SolvedPoint point;
      point.position_in_cam = position;
      result.paths[i].push_back(point);
    };
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      Track& track = tracks[i];
      const auto& sightings = track.segment->sightings;
      if (track.next == sightings.size() || sightings[track.next].frame != frame) continue;
      const Vec3d ray{sightings[track.next].ray.x, sightings[track.next].ray.y, 1};
      const bool gap = track.next > 0 && sightings[track.next - 1].frame != frame - 1;
      if (gap) track.solved_frames = 0;
      if (track.solved_frames > 0) {
        there.push_back(i);
        animals.push_back({ray, track.solved_frames, track.last, track.before_last});
        depths.push_back(std::clamp(track.last.z, options.near, options.far));
        continue;
      }
      const auto assigned = first_depths.find(track.segment->id);
      const double depth = gap                                                ? track.last.z
                           : frame == first && assigned != first_depths.end() ? assigned->second
                                                                              : mean_depth;
      take(i, depth * ray);
    }
    if (!animals.empty()) {
      const auto minimize = optimizer == LinOptimizer::kCobyla ? internal::MinimizeLinByCobyla
                                                               : internal::MinimizeLinByCeres;
      bool exhausted = false;
      result.report.final_cost += minimize(options, fps, animals, &depths, &exhausted);
      result.report.exhausted += exhausted ? 1 : 0;
      ++result.report.frames;
      for (std::size_t k = 0; k < there.size(); ++k) take(there[k], depths[k] * animals[k].ray);
    }
    if (count > 0) mean_depth = sum / count;
  }
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    FillVelocities(fps, *tracks[i].segment, &result.paths[i]);
  }
  Report(progress, last - first + 1, last - first + 1);
  return result;
}

}  // namespace flocklift
