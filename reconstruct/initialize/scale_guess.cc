// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/scale_guess.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "reconstruct/initialize/triangulation.h"

namespace flocklift {
namespace {

// Of directions in space at random, the rms share across the line of sight is sqrt(2/3).
constexpr double kShareAcross = 0.816;

double Quantile(std::vector<double> values, double share, double otherwise) {
  if (values.empty()) return otherwise;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(
                                          share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

Vec3d PlaceAt(const Segments& segments, const Sighting& s) {
  const auto frame = static_cast<std::size_t>(std::lround(s.time * segments.fps));
  return segments.camera_places[std::min(frame, segments.camera_places.size() - 1)];
}

// How an animal moves over half a second or what there is of it, against the depth that it may
// have: its velocity across is depth * ray + camera.
struct Drift {
  Vec2d ray;     // [1/s]
  Vec2d camera;  // of a moving camera [m/s]

  double Across(double depth) const {
    return std::hypot(depth * ray.x + camera.x, depth * ray.y + camera.y);
  }
};

void AddDrifts(const Segments& segments, const Segment& segment, std::vector<Drift>* drifts) {
  constexpr double kSpan = 0.5;
  const auto& s = segment.sightings;
  for (std::size_t begin = 0, end = 0; begin < s.size(); begin = end) {
    while (end < s.size() && s[end].time - s[begin].time < kSpan) ++end;
    const Sighting& last = s[std::min(end, s.size() - 1)];
    const double dt = last.time - s[begin].time;
    if (dt < 0.5 * kSpan) continue;
    Drift drift{{(last.ray.x - s[begin].ray.x) / dt, (last.ray.y - s[begin].ray.y) / dt}, {}};
    if (!segments.camera_places.empty()) {
      const Vec3d moved = (1 / dt) * (PlaceAt(segments, last) - PlaceAt(segments, s[begin]));
      drift.camera = {moved.x - last.ray.x * moved.z, moved.y - last.ray.y * moved.z};
    }
    drifts->push_back(drift);
  }
}

// Second derivatives of the rays by parabolas over windows of about half a second, squared, and
// what noise makes of them.
void AddImageAccelerations(const Segment& segment, std::vector<double>* squares) {
  constexpr double kSpan = 0.6;
  const auto& s = segment.sightings;
  for (std::size_t begin = 0, end = 0; begin < s.size(); begin = end) {
    while (end < s.size() && s[end].time - s[begin].time < kSpan) ++end;
    const std::size_t n = end - begin;
    if (n < 5 || s[end - 1].time - s[begin].time < 0.7 * kSpan) continue;
    const double middle = 0.5 * (s[begin].time + s[end - 1].time);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    double noise = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const double t = s[k].time - middle;
      const Eigen::Vector3d row(1, t, 0.5 * t * t);
      normal += row * row.transpose();
      right += row * Eigen::RowVector2d(s[k].ray.x, s[k].ray.y);
      noise += s[k].ray_sd * s[k].ray_sd / static_cast<double>(n);
    }
    const Eigen::Matrix3d inverse = normal.inverse();
    const Eigen::RowVector2d a = inverse.row(2) * right;
    for (int axis = 0; axis < 2; ++axis) {
      squares->push_back(a[axis] * a[axis] - noise * inverse(2, 2));
    }
  }
}

double LateralSpread(const Segments& segments) {
  struct Moments {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0;
  };
  std::map<int, Moments> frames;
  for (const Segment& segment : segments.segments) {
    for (const Sighting& s : segment.sightings) {
      Moments& m = frames[s.frame];
      m.n += 1;
      m.x += s.ray.x;
      m.y += s.ray.y;
      m.xx += s.ray.x * s.ray.x;
      m.yy += s.ray.y * s.ray.y;
    }
  }
  double x = 0, y = 0, count = 0;
  for (const auto& [frame, m] : frames) {
    if (m.n < 2) continue;
    x += m.xx - m.x * m.x / m.n;
    y += m.yy - m.y * m.y / m.n;
    count += m.n - 1;
  }
  return count > 0 ? std::sqrt(std::max(std::max(x, y) / count, 1e-8)) : 0.1;
}

double MedianSpeed(const std::vector<Drift>& drifts, double depth) {
  std::vector<double> speeds;
  for (const Drift& drift : drifts) speeds.push_back(drift.Across(depth));
  return std::max(Quantile(std::move(speeds), 0.5, 0.1 * depth), 1e-6 * depth) / kShareAcross;
}

// The depth at which the flock flies at `speed`. A camera that moves makes more than one possible:
// the nearest of the best.
double LogDepthOfSpeed(const std::vector<Drift>& drifts, bool camera_moves, double speed) {
  if (!camera_moves) return std::log(speed / MedianSpeed(drifts, 1));
  double best = 0, least = 1e300;
  for (double log_depth = 0; log_depth < 8; log_depth += 0.05) {
    const double off = std::abs(std::log(MedianSpeed(drifts, std::exp(log_depth)) / speed));
    if (off < least - 0.02) {
      least = off;
      best = log_depth;
    }
  }
  return best;
}

std::vector<double> TriangulatedLogDepths(const Segments& segments) {
  std::vector<double> depths;
  for (const Segment& segment : segments.segments) {
    for (const View& view : segment.views) {
      const auto ray = RayAt(segment, view.time);
      const auto depth = ray ? TriangulatedDepth(*ray, view) : std::nullopt;
      if (depth) depths.push_back(std::log(*depth));
    }
  }
  return depths;
}

}  // namespace

ScaleGuess GuessScale(const Knowledge& knowledge, const Segments& segments) {
  std::vector<Drift> drifts;
  std::vector<double> sizes, accelerations;
  for (const Segment& segment : segments.segments) {
    AddDrifts(segments, segment, &drifts);
    AddImageAccelerations(segment, &accelerations);
    for (const Sighting& s : segment.sightings) {
      if (s.log_size) sizes.push_back(*s.log_size);
    }
  }
  const double log_size = Quantile(sizes, 0.5, 0);

  ScaleGuess guess;
  guess.lateral_spread = LateralSpread(segments);
  // The median of a squared normal is 0.455 of its variance.
  guess.image_acceleration =
      std::sqrt(std::max(0.0, Quantile(std::move(accelerations), 0.5, 0) / 0.455));
  const std::vector<double> met = TriangulatedLogDepths(segments);
  if (!met.empty()) {
    guess.log_depth = Quantile(met, 0.5, 0);
  } else if (knowledge.wingspan && !sizes.empty()) {
    guess.log_depth = std::log(knowledge.wingspan->mean) - log_size;
  } else if (knowledge.near && knowledge.far) {
    guess.log_depth = 0.5 * std::log(*knowledge.near * *knowledge.far);
  } else if (knowledge.speed) {
    guess.log_depth =
        LogDepthOfSpeed(drifts, !segments.camera_places.empty(), knowledge.speed->mean);
  } else {
    double sum = 0;
    for (const Anchor& anchor : knowledge.anchors) {
      sum += std::log(std::max(anchor.position.z, 1e-3));
    }
    guess.log_depth = sum / static_cast<double>(std::max<std::size_t>(1, knowledge.anchors.size()));
  }
  guess.log_speed = knowledge.speed ? std::log(knowledge.speed->mean)
                                    : std::log(MedianSpeed(drifts, std::exp(guess.log_depth)));
  guess.log_width =
      knowledge.wingspan ? std::log(knowledge.wingspan->mean) : guess.log_depth + log_size;

  // A flock is seldom deeper than several times its width; sizes tell the extremes apart.
  const double spread = std::clamp(6 * guess.lateral_spread, 0.5, 1.5);
  guess.log_near = guess.log_depth - spread;
  guess.log_far = guess.log_depth + spread;
  if (!sizes.empty() && knowledge.wingspan) {
    guess.log_near = std::min(guess.log_near, guess.log_width - Quantile(sizes, 0.98, 0) - 0.2);
    guess.log_far = std::max(guess.log_far, guess.log_width - Quantile(sizes, 0.02, 0) + 0.2);
  }
  if (!met.empty()) {
    guess.log_near = std::min(guess.log_near, Quantile(met, 0.02, 0) - 0.2);
    guess.log_far = std::max(guess.log_far, Quantile(met, 0.98, 0) + 0.2);
  }
  if (knowledge.near) guess.log_near = std::log(*knowledge.near);
  if (knowledge.far) guess.log_far = std::log(*knowledge.far);
  if (guess.log_far <= guess.log_near + 0.05) {
    (knowledge.far && !knowledge.near ? guess.log_near : guess.log_far) =
        knowledge.far && !knowledge.near ? guess.log_far - 1 : guess.log_near + 1;
  }
  guess.log_depth = std::clamp(guess.log_depth, guess.log_near, guess.log_far);
  return guess;
}

}  // namespace flocklift
