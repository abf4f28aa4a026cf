// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/observed_flock.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

// The cubic between two frames whose end slopes are those of the parabolas through three frames
// each; the chord's where the third is not near.
Vec3d Bridge(const std::vector<TrajectoryPoint>& points, std::size_t before, int frame) {
  const TrajectoryPoint& a = points[before];
  const TrajectoryPoint& b = points[before + 1];
  const double width = b.frame - a.frame;
  const Vec3d chord = (b.position - a.position) / width;
  const auto slope = [&](const TrajectoryPoint& end, std::size_t neighbor) {
    if (neighbor >= points.size()) return chord;  // also before the first: unsigned
    const double step = end.frame - points[neighbor].frame;
    if (std::abs(step) > 2) return chord;
    const Vec3d outer = (end.position - points[neighbor].position) / step;
    return (outer * width + chord * std::abs(step)) / (width + std::abs(step));
  };
  const Vec3d slope_a = slope(a, before - 1), slope_b = slope(b, before + 2);
  const double u = (frame - a.frame) / width;
  const double u2 = u * u, u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * a.position + ((u3 - 2 * u2 + u) * width) * slope_a +
         (3 * u2 - 2 * u3) * b.position + ((u3 - u2) * width) * slope_b;
}

}  // namespace

ObservedFlock::ObservedFlock(const Trajectories& trajectories, double fps, int bridged_gap)
    : dt_(1.0 / fps), span_(SpanOf(trajectories)) {
  Check(fps > 0, "fps must be positive");
  if (span_.last < span_.first) return;
  alive_.resize(static_cast<std::size_t>(span_.last - span_.first) + 1);
  for (const Trajectory& trajectory : trajectories.trajectories) {
    const auto& points = trajectory.points;
    const int animal = static_cast<int>(tracks_.size());
    Track& track = tracks_.emplace_back();
    if (points.empty()) continue;
    track.first = points.front().frame;
    const auto frames = static_cast<std::size_t>(points.back().frame - track.first) + 1;
    track.position.resize(frames);
    track.flag.resize(frames);
    if (trajectories.has_sd_depth) track.sd_depth.resize(frames);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto at = static_cast<std::size_t>(points[k].frame - track.first);
      track.position[at] = points[k].position;
      track.flag[at] = kMeasured;
      if (trajectories.has_sd_depth) track.sd_depth[at] = points[k].sd_depth;
      if (k + 1 == points.size() || points[k + 1].frame - points[k].frame - 1 > bridged_gap) {
        continue;
      }
      for (int f = points[k].frame + 1; f < points[k + 1].frame; ++f) {
        const auto gap = static_cast<std::size_t>(f - track.first);
        track.position[gap] = Bridge(points, k, f);
        track.flag[gap] = kBridged;
      }
    }
    for (std::size_t k = 0; k < frames; ++k) {
      if (track.flag[k] == 0) continue;
      alive_[static_cast<std::size_t>(track.first - span_.first) + k].push_back(animal);
    }
  }
}

std::uint8_t ObservedFlock::Flag(int animal, int frame) const {
  const Track& track = tracks_[static_cast<std::size_t>(animal)];
  const int at = frame - track.first;
  if (at < 0 || at >= static_cast<int>(track.flag.size())) return 0;
  return track.flag[static_cast<std::size_t>(at)];
}

const std::vector<int>& ObservedFlock::Alive(int frame) const {
  static const std::vector<int> kNobody;
  if (frame < span_.first || frame > span_.last) return kNobody;
  return alive_[static_cast<std::size_t>(frame - span_.first)];
}

FrameSpan ObservedFlock::Life(int animal) const {
  const Track& track = tracks_[static_cast<std::size_t>(animal)];
  if (track.flag.empty()) return {};
  return {track.first, track.first + static_cast<int>(track.flag.size()) - 1};
}

const Vec3d& ObservedFlock::Position(int animal, int frame) const {
  FLOCKLIFT_DCHECK(Has(animal, frame));
  const Track& track = tracks_[static_cast<std::size_t>(animal)];
  return track.position[static_cast<std::size_t>(frame - track.first)];
}

double ObservedFlock::SdDepth(int animal, int frame) const {
  const Track& track = tracks_[static_cast<std::size_t>(animal)];
  return track.sd_depth.empty() ? 0 : track.sd_depth[static_cast<std::size_t>(frame - track.first)];
}

int ObservedFlock::State::Find(int wanted) const {
  const auto found = std::lower_bound(animal.begin(), animal.end(), wanted);
  return found != animal.end() && *found == wanted ? static_cast<int>(found - animal.begin()) : -1;
}

Vec3d ObservedFlock::Slope(int animal, int frame) const {
  const int before = Has(animal, frame - 1) ? 1 : 0, after = Has(animal, frame + 1) ? 1 : 0;
  if (before + after == 0) return {};
  return (Position(animal, frame + after) - Position(animal, frame - before)) /
         static_cast<double>(before + after);
}

ObservedFlock::State ObservedFlock::Between(int frame, int part, int parts,
                                            double engine_step) const {
  const double u = static_cast<double>(part) / parts, w = u - 0.5 * engine_step;
  State state;
  for (const int animal : Alive(frame)) {
    const bool after = Has(animal, frame + 1), before = Has(animal, frame - 1);
    if (part == 0 ? !before && !after : !after) continue;
    const Vec3d& x0 = Position(animal, frame);
    const Vec3d slope0 = Slope(animal, frame);
    Vec3d position = x0, velocity = slope0;
    if (after) {
      const Vec3d& x1 = Position(animal, frame + 1);
      const Vec3d slope1 = Slope(animal, frame + 1);
      // x0 + a t + b t^2 + c t^3
      const Vec3d b = 3.0 * (x1 - x0) - 2.0 * slope0 - slope1;
      const Vec3d c = slope0 + slope1 - 2.0 * (x1 - x0);
      position = x0 + u * (slope0 + u * (b + u * c));
      velocity = slope0 + w * (2.0 * b + (3 * w) * c);
    }
    if (w < 0 && before) {
      const Vec3d& x1 = Position(animal, frame - 1);
      const Vec3d slope1 = Slope(animal, frame - 1);  // the same cubic, time reversed
      const Vec3d b = 3.0 * (x1 - x0) + 2.0 * slope0 + slope1;
      const Vec3d c = 2.0 * (x0 - x1) - slope0 - slope1;
      velocity = slope0 - (-w) * (2.0 * b + (3 * -w) * c);
    }
    state.animal.push_back(animal);
    state.position.push_back(position);
    state.velocity.push_back(velocity / dt_);
  }
  return state;
}

ObservedFlock::State ObservedFlock::Foreseen(int frame, int span, int ahead) const {
  State state;
  for (const int animal : Alive(frame)) {
    int frames = 1;
    while (frames <= span && Has(animal, frame - frames)) ++frames;
    if (frames < 2) continue;
    // At times t = -(frames - 1) / 2 .. (frames - 1) / 2 the polynomials 1, t and t^2 - s are
    // orthogonal, s the mean of t^2.
    const double middle = 0.5 * (frames - 1);
    double s = 0;
    for (int k = 0; k < frames; ++k) s += (middle - k) * (middle - k) / frames;
    Vec3d mean, slope, curve;
    double slope_square = 0, curve_square = 0;
    for (int k = 0; k < frames; ++k) {
      const Vec3d& x = Position(animal, frame - k);
      const double t = middle - k, q = t * t - s;
      mean += x;
      slope += t * x;
      curve += q * x;
      slope_square += t * t;
      curve_square += q * q;
    }
    mean = mean / static_cast<double>(frames);
    slope = slope / slope_square;
    curve = frames > 2 ? curve / curve_square : Vec3d{};
    const double t = middle + ahead;
    state.animal.push_back(animal);
    state.position.push_back(mean + t * slope + (t * t - s) * curve);
    state.velocity.push_back((slope + (2 * t) * curve) / dt_);
  }
  return state;
}

}  // namespace flocklift
