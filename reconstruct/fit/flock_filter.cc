// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/flock_filter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "reconstruct/fit/filter_track.h"
#include "reconstruct/fit/limited_velocity.h"
#include "reconstruct/fit/state_transition.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace {

using internal::Drift;
using internal::FindGain;
using internal::Kick;
using Track = internal::FilterTrack;

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;

// A speed at its limit is never held for better known than by this share of a step's noise: the
// rest is tails that are no Gaussian's, and a gain that trusted them would run away.
constexpr double kLeastKick = 0.2;
constexpr int kForgotten = 4;  // frames after which an innovation tells nothing of a limit any more
// Positions are never taken for better than this share of how far the noise moves them in a frame:
// the gain would be singular.
constexpr double kLeastVariance = 1e-6;

Vector3 AsEigen(const Vec3d& v) { return {v.x, v.y, v.z}; }
Vec3d AsVec3(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

class Filter {
 public:
  Filter(const FilterOptions& options, const ProcessModel& model, const std::vector<double>& theta,
         const FlockNoise& noise, const FilterInput& input, FilterSweep memory)
      : options_(options),
        model_(model),
        theta_(theta),
        input_(input),
        steps_(StepsAFrame(options.substeps)),
        q_(2 * noise.diffusion),
        variance_(noise.position_variance + kLeastVariance * q_ * std::pow(input.dt(), 3)),
        tracks_(static_cast<std::size_t>(input.animals())),
        last_(static_cast<std::size_t>(input.animals())),
        sweep_(std::move(memory)) {
    sweep_.innovations.clear();
    sweep_.innovations.reserve(input.sightings());
    sweep_.cost = 0;
    if (model.speed_range) range_ = model.speed_range(theta);
  }

  FilterSweep Run() {
    int frame = input_.first_frame();
    for (const auto& sightings : input_.frames()) {
      Predict();
      Correct(frame, sightings);
      Welcome();
      ++frame;
    }
    return std::move(sweep_);
  }

 private:
  // Means through the engine's steps, all animals together; covariances each by itself.
  void Predict() {
    Gather();
    const std::size_t n = indices_.size();
    if (n == 0) return;
    Move();
    for (std::size_t k = 0; k < n; ++k) {
      Track& track = tracks_[indices_[k]];
      track.x = x_[k];
      track.v = v_[k];
      if (track.is_limited) continue;  // step by step, in Move
      if (!track.has_transition || !(track.slope == slopes_[k])) {
        track.slope = slopes_[k];
        track.transition = TransitionOver(
            MakeStateStep(input_.dt(), options_.substeps, q_, input_.rounding(), track.slope),
            steps_);
        track.has_transition = true;
        track.settled = false;
      }
      if (track.settled) continue;
      const Matrix6& step = track.transition.deviation;
      track.covariance = step * track.covariance * step.transpose() + track.transition.noise;
    }
  }

  void Gather() {
    indices_.clear();
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      if (tracks_[i].active) indices_.push_back(i);
    }
    const std::size_t n = indices_.size();
    x_.resize(n);
    v_.resize(n);
    a_.resize(n);
    slopes_.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      x_[k] = tracks_[indices_[k]].x;
      v_[k] = tracks_[indices_[k]].v;
    }
  }

  void Move() {
    const bool continuous = options_.substeps <= 0;
    const double h = input_.dt() / steps_;
    const std::size_t n = x_.size();
    for (const std::size_t i : indices_) tracks_[i].is_limited = false;
    for (int step = 0; step < steps_; ++step) {
      model_.evaluate(theta_, x_, v_, a_,
                      step == 0 ? std::span<OwnSlope>(slopes_) : std::span<OwnSlope>());
      if (!continuous) {
        for (std::size_t k = 0; k < n; ++k) {
          v_[k] += h * a_[k];
          Limit(step, k);
          x_[k] += h * v_[k];
        }
        continue;
      }
      const std::vector<Vec3d> x0 = x_, v0 = v_;
      for (std::size_t k = 0; k < n; ++k) {  // to the middle, and by its acceleration
        x_[k] += 0.5 * h * v_[k];
        v_[k] += 0.5 * h * a_[k];
      }
      model_.evaluate(theta_, x_, v_, a_, {});
      for (std::size_t k = 0; k < n; ++k) {
        x_[k] = x0[k] + h * v0[k] + 0.5 * h * h * a_[k];
        v_[k] = v0[k] + h * a_[k];
        Limit(step, k);
      }
    }
  }

  // What the speed limit makes of a mean and its covariance. From the first step of a frame on in
  // which it may act, the covariance is taken along with the mean.
  void Limit(int step, std::size_t k) {
    if (!range_) return;
    Track& track = tracks_[indices_[k]];
    const double speed = Norm(v_[k]);
    if (!track.is_limited) {
      const double variance = track.covariance.bottomRightCorner<3, 3>().trace() + q_ * input_.dt();
      if (speed <= 0 || !IsNearLimit(*range_, speed, std::sqrt(variance))) return;
      track.is_limited = true;
      track.has_transition = track.settled = false;  // what acts here, acts in this frame alone
      track.step = MakeStateStep(input_.dt(), options_.substeps, q_, input_.rounding(), slopes_[k]);
      for (int before = 0; before < step; ++before) {
        Kick(&track);
        Drift(&track);
      }
    }
    Kick(&track);
    if (speed > 0) {
      const LimitedVelocity limited =
          LimitVelocity(*range_, AsEigen(v_[k]), track.covariance.bottomRightCorner<3, 3>(),
                        kLeastKick * (q_ * input_.dt() / steps_ + input_.rounding().velocity));
      v_[k] = AsVec3(limited.mean);
      if (limited.acts) track.until_forgotten = kForgotten;
      Matrix6 kept = Matrix6::Identity();
      kept.bottomRightCorner<3, 3>() = limited.kept;
      track.covariance = kept * track.covariance * kept.transpose();
      track.covariance.bottomRightCorner<3, 3>() += limited.noise;
    }
    Drift(&track);
  }

  void Correct(int frame, const std::vector<FilterInput::Sighting>& sightings) {
    for (Track& track : tracks_) ++track.unseen;
    for (const FilterInput::Sighting& sighting : sightings) {
      Track& track = tracks_[static_cast<std::size_t>(sighting.animal)];
      LastSeen& last = last_[static_cast<std::size_t>(sighting.animal)];
      if (track.active) {
        Update(frame, sighting, &track);
      } else if (last.frame == frame - 1) {
        Enter(sighting.position, last.position, &track);
        entered_.push_back(static_cast<std::size_t>(sighting.animal));
      }
      track.unseen = 0;
      last = {frame, sighting.position};
    }
    for (Track& track : tracks_) {
      if (track.unseen > 0 && track.settled) {  // its covariance is as after the last correction
        const Matrix6& step = track.transition.deviation;
        track.covariance = step * track.covariance * step.transpose() + track.transition.noise;
        track.settled = false;
      }
      if (track.unseen > options_.bridged_gap) track.active = false;
    }
  }

  // The velocity of who has just entered is that of halfway back to where it was seen before. What
  // the others feel of an error of it no covariance tells: without process noise a filter that
  // starts with one is misled for frames.
  void Welcome() {
    if (entered_.empty()) return;
    const double since = 0.5 * (options_.substeps > 0 ? 1 - 1.0 / steps_ : 1) * input_.dt();
    std::vector<Vec3d> before;
    for (const std::size_t i : entered_) before.push_back(tracks_[i].v);
    for (int round = 0; round < 2; ++round) {
      Gather();
      model_.evaluate(theta_, x_, v_, a_, {});
      for (std::size_t k = 0, next = 0; k < indices_.size() && next < entered_.size(); ++k) {
        if (indices_[k] != entered_[next]) continue;
        Vec3d v = before[next++] + since * a_[k];
        const double speed = Norm(v);
        if (range_ && speed > 0) v = std::clamp(speed, range_->low, range_->high) / speed * v;
        tracks_[indices_[k]].v = v;
      }
    }
    entered_.clear();
  }

  // Diffuse before the two positions.
  void Enter(const Vec3d& now, const Vec3d& before, Track* track) const {
    const double dt = input_.dt();
    track->active = true;
    track->has_transition = track->settled = false;
    track->x = now;
    track->v = (now - before) / dt;
    const Matrix3 one = Matrix3::Identity();
    const double change = input_.second_differences()[0] / (dt * dt);
    const double r = variance_;
    track->covariance << r * one, r / dt * one, r / dt * one,
        (2 * r / (dt * dt) + q_ * dt / 3 + change) * one;
  }

  void Update(int frame, const FilterInput::Sighting& sighting, Track* track) {
    if (!track->settled) FindGain(variance_, track);
    const Vector3 innovation = AsEigen(sighting.position - track->x);
    const Eigen::Matrix<double, 6, 1> step = track->gain * innovation;
    track->x += AsVec3(step.head<3>());
    track->v += AsVec3(step.tail<3>());
    sweep_.cost +=
        track->log_determinant + innovation.dot(track->innovation_information * innovation);
    const Matrix3& s = track->innovation_covariance;
    sweep_.innovations.push_back(
        {.frame = frame,
         .animal = sighting.animal,
         .value = {innovation.x(), innovation.y(), innovation.z()},
         .covariance = {s(0, 0), s(0, 1), s(0, 2), s(1, 1), s(1, 2), s(2, 2)},
         .is_limited = track->until_forgotten > 0});
    if (track->until_forgotten > 0) --track->until_forgotten;
  }

  struct LastSeen {
    int frame = std::numeric_limits<int>::min();
    Vec3d position;
  };

  const FilterOptions& options_;
  const ProcessModel& model_;
  const std::vector<double>& theta_;
  const FilterInput& input_;
  int steps_;  // a frame
  double q_, variance_;
  std::vector<Track> tracks_;
  std::vector<LastSeen> last_;
  std::vector<std::size_t> indices_;  // of active tracks
  std::vector<std::size_t> entered_;  // in this frame
  std::vector<Vec3d> x_, v_, a_;
  std::vector<OwnSlope> slopes_;
  std::optional<SpeedRange> range_;
  FilterSweep sweep_;
};

}  // namespace

FilterSweep RunFilter(const FilterOptions& options, const ProcessModel& model,
                      const std::vector<double>& theta, const FlockNoise& noise,
                      const FilterInput& input, FilterSweep memory) {
  Check(noise.diffusion > 0, "a filter needs a positive diffusion");
  return Filter(options, model, theta, noise, input, std::move(memory)).Run();
}

}  // namespace flocklift
