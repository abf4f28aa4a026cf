// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/body_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "reconstruct/cost_functions/path.h"
#include "reconstruct/cost_functions/size.h"

namespace flocklift::internal {
namespace {

// Length of the body or log of its trunk, amplitude of the wingbeat, lean.
using Unknowns = Eigen::Vector3d;
constexpr int kLeanAt = 2;

struct Look {
  Vec2d ray;
  Vec3d heading, curve;
  Eigen::Vector2d seen;  // ellipticity; of boxes the first alone counts
};

// In the mean over half a second around a knot.
std::vector<Look> LooksOf(const BatchModel& model, const std::vector<Bird>& birds) {
  constexpr double kInterval = 0.5;  // [s]
  const int stride = std::max(1, static_cast<int>(std::lround(kInterval / model.knot_interval)));
  std::vector<Look> looks;
  for (const Bird& bird : birds) {
    for (int first = 0; first < bird.knots; first += stride) {
      const int end = std::min(bird.knots, first + stride);
      Eigen::Vector2d sum(0, 0);
      double count = 0;
      for (int knot = first; knot < end; ++knot) {
        const auto& form = bird.form[static_cast<std::size_t>(knot)];
        if (!form) continue;
        sum += Eigen::Vector2d(form->x, form->y);
        ++count;
      }
      if (count == 0) continue;
      const int knot = (first + end - 1) / 2;
      const PathState<double> q =
          StateAtKnot(&bird.path[3 * static_cast<std::size_t>(knot)], 1 / model.knot_interval);
      const double time = (bird.first_knot + knot) * model.knot_interval;
      const Vec3d w = VelocityOverDepth(q, model.camera.At(time));
      if (!(Norm(w) > bird.softening)) continue;
      looks.push_back(
          {{q.x, q.y}, Normalized(w), bird.curve[static_cast<std::size_t>(knot)], sum / count});
    }
  }
  return looks;
}

class FormFit {
 public:
  FormFit(const Vec3d& up_in_cam, BodyImage::Kind kind, const std::vector<Look>& looks,
          const Uncertain& lean)
      : up_in_cam_(up_in_cam), kind_(kind), looks_(looks) {
    const BodyShape usual;
    const FlockBody birds;
    const bool box = kind == BodyImage::Kind::kBox;
    mean_ << (box ? usual.length : std::log(usual.trunk)), usual.amplitude, lean.mean;
    sd_ << (box ? birds.length_sd : 0.6), birds.amplitude_sd, lean.sd;
  }

  struct Found {
    Unknowns at, sd;
    bool weak_perspective = false;
    double cost = 0;  // -2 log of the posterior, but for a constant; infinite: nothing found
  };
  Found From(double lean, bool weak_perspective) const {
    constexpr int kIterations = 6;
    constexpr double kHuber = 2;      // [sd]
    constexpr double kLongest = 1.5;  // step, in sds of the prior
    constexpr double kLeastSd = 0.01;
    Found found{.at = mean_, .sd = sd_, .weak_perspective = weak_perspective};
    found.at[kLeanAt] = lean;
    double error_sd = 0.2;
    const double dimensions = kind_ == BodyImage::Kind::kBox ? 1 : 2;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Eigen::Matrix3d matrix = sd_.cwiseAbs2().cwiseInverse().asDiagonal();
      Eigen::Vector3d pull = matrix * (mean_ - found.at);
      const double prior = pull.dot(mean_ - found.at);
      double squares = 0;
      const Guess now = GuessOf(found.at, weak_perspective);
      std::array<Guess, 3> moved{now, now, now};
      for (int a = 0; a < 3; ++a) {
        moved[static_cast<std::size_t>(a)] =
            GuessOf(found.at + kStep * Unknowns::Unit(a), weak_perspective);
      }
      for (const Look& look : looks_) {
        const Eigen::Vector2d here = EllipticityOf(now, look);
        const Eigen::Vector2d error = look.seen - here;
        Eigen::Matrix<double, 2, 3> slopes;
        for (int a = 0; a < 3; ++a) {
          slopes.col(a) = (EllipticityOf(moved[static_cast<std::size_t>(a)], look) - here) / kStep;
        }
        const double weight = std::min(1.0, kHuber * error_sd / std::max(error.norm(), 1e-12));
        squares += weight * error.squaredNorm();
        const double share = weight / (error_sd * error_sd);
        matrix += share * slopes.transpose() * slopes;
        pull += share * slopes.transpose() * error;
      }
      const double n = dimensions * static_cast<double>(looks_.size());
      error_sd = std::max(std::sqrt(squares / n), kLeastSd);
      found.cost = 2 * n * std::log(error_sd) + prior;
      const Eigen::Matrix3d covariance = matrix.inverse();
      found.sd = covariance.diagonal().cwiseSqrt();
      const Eigen::Vector3d step = covariance * pull;
      for (int a = 0; a < 3; ++a) {
        found.at[a] += std::clamp(step[a], -kLongest * sd_[a], kLongest * sd_[a]);
      }
    }
    if (!found.at.allFinite() || !found.sd.allFinite() || !std::isfinite(found.cost)) {
      found.cost = std::numeric_limits<double>::infinity();
    }
    return found;
  }

  BodyShape ShapeOf(const Unknowns& x) const {
    BodyShape shape{.amplitude = x[1]};
    (kind_ == BodyImage::Kind::kBox ? shape.length : shape.trunk) =
        kind_ == BodyImage::Kind::kBox ? x[0] : std::exp(x[0]);
    return shape;
  }

 private:
  static constexpr double kStep = 1e-4;  // of numeric differences

  struct Guess {
    BodyImage body;
    double lean = 0;
    bool weak_perspective = false;
  };
  Guess GuessOf(const Unknowns& x, bool weak_perspective) const {
    return {BodyImage(kind_, ShapeOf(x)), x[kLeanAt], weak_perspective};
  }

  Eigen::Vector2d EllipticityOf(const Guess& guess, const Look& look) const {
    const Vec3d lift = up_in_cam_ + guess.lean * look.curve;
    const Vec3d across = Cross(look.heading, lift);
    const double size = Norm(across);
    if (!(size > 0.15 * Norm(lift))) return look.seen;  // nearly along it: the side is anywhere
    const Vec3d side = (1 / size) * across;
    const Vec2d ray = guess.weak_perspective ? Vec2d{} : look.ray;
    const Vec2d e = guess.body.Ellipticity(ImageOf(look.heading, ray), ImageOf(side, ray),
                                           ImageOf(Cross(side, look.heading), ray));
    return {e.x, kind_ == BodyImage::Kind::kBox ? look.seen[1] : e.y};
  }

  Vec3d up_in_cam_;
  BodyImage::Kind kind_;
  const std::vector<Look>& looks_;
  Unknowns mean_, sd_;
};

// By what the cost of weak perspective is over the other's. Errors are in part those of the model,
// alike in many looks: no more than some count.
bool IsWeakPerspective(double cost_over_other, std::size_t looks) {
  constexpr double kMost = 200, kBeforehand = 0.1;
  const double share = std::min(1.0, kMost / static_cast<double>(looks));
  return share * cost_over_other < 2 * std::log(kBeforehand / (1 - kBeforehand));
}

}  // namespace

bool FitBody(const Segments& segments, const Uncertain& lean, const std::vector<Bird>& birds,
             BatchModel* model) {
  // No bird is as simple as the model. The lean in the solver is held less tightly than it is seen:
  // curves are those of an earlier solution, and sizes that follow them closely hold its errors.
  constexpr double kLengthSd = 0.03, kAmplitudeSd = 0.1, kLeanSd = 0.1;
  if (!model->up_in_cam) return false;
  const std::vector<Look> looks = LooksOf(*model, birds);
  if (looks.empty()) return false;
  const auto kind = segments.has_shapes ? BodyImage::Kind::kSilhouette : BodyImage::Kind::kBox;
  const FormFit fit(*model->up_in_cam, kind, looks, lean);
  const auto from = [&fit](bool weak_perspective) {
    const FormFit::Found level = fit.From(0, weak_perspective);
    const FormFit::Found banked = fit.From(1, weak_perspective);
    return level.cost <= banked.cost ? level : banked;  // there may be two modes
  };
  FormFit::Found best = from(false);
  if (!segments.camera_turns) {
    const FormFit::Found weak = from(true);
    if (IsWeakPerspective(weak.cost - best.cost, looks.size())) best = weak;
  }
  if (std::isinf(best.cost)) return false;
  const FlockBody birds_in_general;
  FlockBody& body = model->body;
  body.image = BodyImage(kind, fit.ShapeOf(best.at));
  body.length_sd = birds_in_general.length_sd;
  if (kind == BodyImage::Kind::kBox) {
    body.length_sd = std::min(body.length_sd, std::hypot(best.sd[0], kLengthSd));
  }
  body.amplitude_sd = std::min(birds_in_general.amplitude_sd, std::hypot(best.sd[1], kAmplitudeSd));
  body.lean = best.at[kLeanAt];
  body.weak_perspective = best.weak_perspective;
  model->lean = {best.at[kLeanAt], std::min(lean.sd, std::hypot(best.sd[kLeanAt], kLeanSd))};
  return true;
}

}  // namespace flocklift::internal
