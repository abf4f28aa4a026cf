// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/box_of_body.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/cost_functions/path.h"
#include "reconstruct/cost_functions/size.h"

namespace flocklift::internal {
namespace {

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

}  // namespace

double BoxRatio(const BodyShape& body, const Vec3d& up, const BatchModel& model,
                const std::vector<Bird>& birds, const Eigen::VectorXd& shared, int stride) {
  const double rate = 1 / model.knot_interval;
  const BodyImage box(BodyImage::Kind::kBox, body);
  const double lean = model.body.share > 0 ? model.body.lean : shared[kLean];
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
                           .camera = model.camera.At(time),
                           .body = &model.body.image,
                           .body_share = model.body.share,
                           .perspective = model.body.Perspective()};
      double error = 0;
      size(c, 0.0, 0.0, shared[kLogTrunk], shared[kLogUp], shared[kLean], &error);
      const double log_size = q.l - error;
      const Vec3d lift = model.up_in_cam ? up + lean * bird.curve[knot] : up;
      const Vec3d velocity = VelocityOverDepth(q, size.camera);
      const double speed = Norm(velocity);
      if (!(speed > 0)) continue;
      const Pose pose = PoseAt((1 / speed) * velocity, lift);
      const Vec2d ray{size.perspective * q.x, size.perspective * q.y};
      sum +=
          box.LogSize(ImageOf(pose.heading, ray), ImageOf(pose.side, ray), ImageOf(pose.up, ray)) -
          log_size;
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
  const FlockBody& body = model.body;
  const BodyShape& shape = body.image.shape();
  double mean = 0, square = 0, by_length = 0, by_amplitude = 0;
  for (const Up& up : PossibleUps(model.up_in_cam)) {
    const auto ratio = [&](double length, double amplitude) {
      return BoxRatio({.length = shape.length + length, .amplitude = shape.amplitude + amplitude},
                      up.direction, model, birds, shared, stride);
    };
    const double longer = ratio(body.length_sd, 0), shorter = ratio(-body.length_sd, 0);
    const double wider = ratio(0, body.amplitude_sd), narrower = ratio(0, -body.amplitude_sd);
    const double here = 0.5 * (longer + shorter + wider + narrower) - ratio(0, 0);
    mean += up.weight * here;
    square += up.weight * here * here;
    by_length += up.weight * 0.5 * (longer - shorter);
    by_amplitude += up.weight * 0.5 * (wider - narrower);
  }
  const double by_up = std::sqrt(std::max(0.0, square - mean * mean));
  return {mean, std::hypot(std::hypot(other_sd, by_up), by_length, by_amplitude)};
}

}  // namespace flocklift::internal
