// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/box_of_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "reconstruct/cost_functions/path.h"
#include "reconstruct/cost_functions/size.h"

namespace flocklift::internal {
namespace {

constexpr double kLengthSd = 0.06, kAmplitudeSd = 0.25;
// The four points have no width: an outline reaches a little further.
constexpr double kMargin = 0.03;
constexpr double kThickness = 0.1;  // of a body, over the wingspan
constexpr int kPhases = 8;

// Unit vectors of a body in flight.
struct Pose {
  Vec3d heading, side, up;
};

Pose PoseAt(const Vec3d& heading, const Vec3d& lift) {
  Vec3d side = Cross(heading, lift);
  if (!(SquaredNorm(side) > 1e-9 * SquaredNorm(lift))) {  // straight up
    side = Cross(heading, std::abs(heading.z) < 0.7 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0});
  }
  side = Normalized(side);
  return {heading, side, Cross(side, heading)};
}

// Where up may be, with its probability.
struct Up {
  Vec3d direction;
  double weight = 1;
};

// Gravity unknown: a formula of degree 5 for means over the sphere, corners and faces of a cube
// (Abramowitz and Stegun 25.4.65). Opposite directions look the same.
std::vector<Up> PossibleUps(const std::optional<Vec3d>& known) {
  if (known) return {{*known, 1}};
  constexpr double kFace = 2.0 / 15, kCorner = 3.0 / 20;
  const double c = 1 / std::sqrt(3.0);
  return {{{1, 0, 0}, kFace},    {{0, 1, 0}, kFace},    {{0, 0, 1}, kFace},   {{c, c, c}, kCorner},
          {{-c, c, c}, kCorner}, {{c, -c, c}, kCorner}, {{c, c, -c}, kCorner}};
}

// log sqrt(W^2 + H^2), in the mean over the wingbeat.
double LogBox(const BodyShape& body, const Pose& pose, const Vec2d& ray) {
  double sum = 0;
  for (int phase = 0; phase < kPhases; ++phase) {
    const double flap = body.amplitude * std::sin(2 * std::numbers::pi * (phase + 0.5) / kPhases);
    const Vec3d tip = 0.5 * std::cos(flap) * pose.side;
    const Vec3d raised = 0.5 * std::sin(flap) * pose.up;
    const Vec3d nose = 0.5 * body.length * pose.heading;
    const std::array<Vec3d, 4> points = {raised + tip, raised - tip, nose, -1.0 * nose};
    Vec2d least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vec2d most{-least.x, -least.y};
    for (const Vec3d& p : points) {
      const Vec2d image{p.x - ray.x * p.z, p.y - ray.y * p.z};
      least = {std::min(least.x, image.x), std::min(least.y, image.y)};
      most = {std::max(most.x, image.x), std::max(most.y, image.y)};
    }
    sum += std::log(
        std::hypot(std::max(most.x - least.x, kThickness), std::max(most.y - least.y, kThickness)));
  }
  return sum / kPhases;
}

}  // namespace

double BoxRatio(const BodyShape& body, const Vec3d& up, const BatchModel& model,
                const std::vector<Bird>& birds, const Eigen::VectorXd& shared, int stride) {
  const double rate = 1 / model.knot_interval;
  double sum = 0;
  int count = 0;
  for (const Bird& bird : birds) {
    for (int knot = 0; knot < bird.knots; knot += stride) {
      if (!bird.size[knot]) continue;
      const double* c = &bird.path[3 * static_cast<std::size_t>(knot)];
      const double time = (bird.first_knot + knot) * model.knot_interval;
      const PathState<double> q = StateAtKnot(c, rate);
      const SizeError size{.rate = rate,
                           .softening = bird.softening,
                           .up_in_cam = model.up_in_cam,
                           .curve = bird.curve[knot],
                           .camera = model.camera.At(time)};
      double error = 0;
      size(c, 0.0, 0.0, shared[kLogTrunk], shared[kLogUp], shared[kLean], &error);
      const double log_root_q = q.l - error;
      const Vec3d lift = model.up_in_cam ? up + shared[kLean] * bird.curve[knot] : up;
      const Vec3d velocity = VelocityOverDepth(q, size.camera);
      const double speed = Norm(velocity);
      if (!(speed > 0)) continue;
      const Pose pose = PoseAt((1 / speed) * velocity, lift);
      sum += LogBox(body, pose, {q.x, q.y}) - log_root_q;
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

Uncertain ExpectedBoxRatio(const BatchModel& model, const std::vector<Bird>& birds,
                           const Eigen::VectorXd& shared, double other_sd) {
  constexpr double kInterval = 0.5;  // between the knots that are looked at [s]
  const int stride = std::max(1, static_cast<int>(std::lround(kInterval / model.knot_interval)));
  // Unscented: the mean and the sd over the two unknowns of the body, from two points along each.
  const BodyShape usual;
  double mean = 0, square = 0, by_length = 0, by_amplitude = 0;
  for (const Up& up : PossibleUps(model.up_in_cam)) {
    const auto ratio = [&](double length, double amplitude) {
      return BoxRatio({usual.length + length, usual.amplitude + amplitude}, up.direction, model,
                      birds, shared, stride);
    };
    const double longer = ratio(kLengthSd, 0), shorter = ratio(-kLengthSd, 0);
    const double wider = ratio(0, kAmplitudeSd), narrower = ratio(0, -kAmplitudeSd);
    const double here = 0.5 * (longer + shorter + wider + narrower) - ratio(0, 0);
    mean += up.weight * here;
    square += up.weight * here * here;
    by_length += up.weight * 0.5 * (longer - shorter);
    by_amplitude += up.weight * 0.5 * (wider - narrower);
  }
  const double by_up = std::sqrt(std::max(0.0, square - mean * mean));
  return {kMargin + mean, std::hypot(std::hypot(other_sd, by_up), by_length, by_amplitude)};
}

}  // namespace flocklift::internal
