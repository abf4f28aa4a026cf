// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/flock_filter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "simulate/core/check.h"
#include "simulate/forces/speed.h"

namespace flocklift {
namespace {

using Matrix3 = Eigen::Matrix3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Gain = Eigen::Matrix<double, 6, 3>;
using Vector3 = Eigen::Vector3d;

constexpr int kContinuousSteps = 2;  // a frame, when time is continuous
constexpr double kSettled = 1e-12;   // relative change of a covariance that counts as none
// Positions are never taken for better than this share of how far the noise moves them in a frame:
// the gain would be singular.
constexpr double kLeastVariance = 1e-6;

Vector3 AsEigen(const Vec3d& v) { return {v.x, v.y, v.z}; }
Vec3d AsVec3(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
Matrix3 AsMatrix(const std::array<double, 9>& m) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.data());
}

// How deviations from the mean and their covariance go over one frame.
struct Transition {
  Matrix6 deviation = Matrix6::Identity();
  Matrix6 noise = Matrix6::Zero();
};

// `clamp`: what the model's speed limit lets through of a velocity's deviation.
Transition TransitionOver(double dt, int substeps, double q, const OwnSlope& slope,
                          const std::optional<Matrix3>& clamp) {
  const int steps = substeps > 0 ? substeps : kContinuousSteps;
  const double h = dt / steps;
  const Matrix3 one = Matrix3::Identity(), dx = AsMatrix(slope.position),
                dv = AsMatrix(slope.velocity);
  Matrix6 step = Matrix6::Identity(), noise;
  if (substeps > 0) {
    step << one + h * h * dx, h * one + h * h * dv, h * dx, one + h * dv;
    noise << h * h * one, h * one, h * one, one;
    noise *= q * h;
  } else {
    Matrix6 rate;
    rate << Matrix3::Zero(), one, dx, dv;
    step += h * rate + 0.5 * h * h * rate * rate;
    noise << h * h / 3 * one, h / 2 * one, h / 2 * one, one;
    noise *= q * h;
  }
  if (clamp) step.bottomRows<3>() = *clamp * step.bottomRows<3>();
  if (clamp && substeps > 0) {  // x moves by the clamped velocity
    step.topRows<3>() << one, Matrix3::Zero();
    step.topRows<3>() += h * step.bottomRows<3>();
  }
  Transition transition;
  for (int k = 0; k < steps; ++k) {
    transition.deviation = step * transition.deviation;
    transition.noise = step * transition.noise * step.transpose() + noise;
  }
  return transition;
}

// One animal's estimate.
struct Track {
  bool active = false;
  int unseen = 0;  // frames since it was measured
  Vec3d x, v;
  Matrix6 covariance = Matrix6::Zero();
  // What the last frame used, which the next one may use again.
  bool has_transition = false, settled = false;
  OwnSlope slope;
  Transition transition;
  Gain gain = Gain::Zero();
  Matrix3 innovation_covariance = Matrix3::Zero(), innovation_information = Matrix3::Zero();
  double log_determinant = 0;
};

class Filter {
 public:
  Filter(const FilterOptions& options, const ProcessModel& model, const std::vector<double>& theta,
         const FlockNoise& noise, const FilterInput& input)
      : options_(options),
        model_(model),
        theta_(theta),
        input_(input),
        q_(2 * noise.diffusion),
        variance_(noise.position_variance + kLeastVariance * q_ * std::pow(input.dt(), 3)),
        tracks_(static_cast<std::size_t>(input.animals())),
        last_(static_cast<std::size_t>(input.animals())) {
    if (model.speed_range) range_ = model.speed_range(theta);
  }

  FilterSweep Run() {
    int frame = input_.first_frame();
    for (const auto& sightings : input_.frames()) {
      Predict();
      Correct(frame, sightings);
      ++frame;
    }
    return std::move(sweep_);
  }

 private:
  // Means through the engine's steps, all animals together; covariances each by itself.
  void Predict() {
    indices_.clear();
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      if (tracks_[i].active) indices_.push_back(i);
    }
    const std::size_t n = indices_.size();
    x_.resize(n);
    v_.resize(n);
    a_.resize(n);
    slopes_.resize(n);
    clamps_.assign(n, std::nullopt);
    for (std::size_t k = 0; k < n; ++k) {
      x_[k] = tracks_[indices_[k]].x;
      v_[k] = tracks_[indices_[k]].v;
    }
    if (n == 0) return;
    Move();
    for (std::size_t k = 0; k < n; ++k) {
      Track& track = tracks_[indices_[k]];
      track.x = x_[k];
      track.v = v_[k];
      if (!track.has_transition || clamps_[k] || !(track.slope == slopes_[k])) {
        track.slope = slopes_[k];
        track.transition =
            TransitionOver(input_.dt(), options_.substeps, q_, track.slope, clamps_[k]);
        track.has_transition = !clamps_[k];  // a clamp is of its frame alone
        track.settled = false;
      }
      if (track.settled) continue;
      const Matrix6& step = track.transition.deviation;
      track.covariance = step * track.covariance * step.transpose() + track.transition.noise;
    }
  }

  void Move() {
    const bool continuous = options_.substeps <= 0;
    const int steps = continuous ? kContinuousSteps : options_.substeps;
    const double h = input_.dt() / steps;
    const std::size_t n = x_.size();
    for (int step = 0; step < steps; ++step) {
      model_.evaluate(theta_, x_, v_, a_,
                      step == 0 ? std::span<OwnSlope>(slopes_) : std::span<OwnSlope>());
      if (!continuous) {
        for (std::size_t k = 0; k < n; ++k) {
          v_[k] += h * a_[k];
          Limit(k);
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
        Limit(k);
      }
    }
  }

  void Limit(std::size_t k) {
    if (!range_) return;
    const double speed = Norm(v_[k]);
    if (speed <= 0 || (speed >= range_->low && speed <= range_->high)) return;
    v_[k] = SpeedLimit::Limit(SpeedLimit::Params<double>{range_->low, range_->high, 0.0}, v_[k]);
    const Vector3 along = AsEigen(v_[k]) / Norm(v_[k]);
    clamps_[k] = Norm(v_[k]) / speed * (Matrix3::Identity() - along * along.transpose());
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
    if (!track->settled) FindGain(track);
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
         .covariance = {s(0, 0), s(0, 1), s(0, 2), s(1, 1), s(1, 2), s(2, 2)}});
  }

  void FindGain(Track* track) const {
    const Matrix6 predicted = track->covariance;
    const Matrix3 noise = variance_ * Matrix3::Identity();
    const Matrix3 s = predicted.topLeftCorner<3, 3>() + noise;
    const Eigen::LLT<Matrix3> llt(s);
    const bool known = track->unseen == 1 && track->innovation_covariance.isApprox(s, kSettled) &&
                       track->has_transition;
    track->innovation_covariance = s;
    track->innovation_information = llt.solve(Matrix3::Identity());
    track->log_determinant = 2 * std::log(llt.matrixL().toDenseMatrix().diagonal().prod());
    const Gain gain = predicted.leftCols<3>() * track->innovation_information;
    Matrix6 left = Matrix6::Identity();
    left.leftCols<3>() -= gain;
    track->settled = known && gain.isApprox(track->gain, kSettled);
    track->gain = gain;
    track->covariance = left * predicted * left.transpose() + gain * noise * gain.transpose();
  }

  struct LastSeen {
    int frame = std::numeric_limits<int>::min();
    Vec3d position;
  };

  const FilterOptions& options_;
  const ProcessModel& model_;
  const std::vector<double>& theta_;
  const FilterInput& input_;
  double q_, variance_;
  std::vector<Track> tracks_;
  std::vector<LastSeen> last_;
  std::vector<std::size_t> indices_;  // of active tracks
  std::vector<Vec3d> x_, v_, a_;
  std::vector<OwnSlope> slopes_;
  std::vector<std::optional<Matrix3>> clamps_;  // of those whose speed limit acted in the frame
  std::optional<SpeedRange> range_;
  FilterSweep sweep_;
};

}  // namespace

FilterInput::FilterInput(const ObservedFlock& flock)
    : first_frame_(flock.span().first), animals_(flock.animals()), dt_(flock.dt()) {
  for (int f = flock.span().first; f <= flock.span().last; ++f) {
    std::vector<Sighting>& sightings = frames_.emplace_back();
    for (int i = 0; i < animals_; ++i) {
      if (flock.Measured(i, f)) sightings.push_back({i, flock.Position(i, f)});
    }
  }
  std::array<double, 3> sums{}, counts{};
  for (int i = 0; i < animals_; ++i) {
    std::array<Vec3d, 3> recent;  // second differences, the newest first
    int run = 0;
    for (int f = flock.Life(i).first; f <= flock.Life(i).last; ++f) {
      run = flock.Measured(i, f) ? run + 1 : 0;
      if (run < 3) continue;
      recent = {flock.Position(i, f) - 2.0 * flock.Position(i, f - 1) + flock.Position(i, f - 2),
                recent[0], recent[1]};
      for (int lag = 0; lag < std::min(3, run - 2); ++lag) {
        const auto at = static_cast<std::size_t>(lag);
        sums[at] += Dot(recent[0], recent[at]) / 3;
        counts[at] += 1;
      }
    }
  }
  for (std::size_t lag = 0; lag < 3; ++lag) second_differences_[lag] = sums[lag] / counts[lag];
}

FilterSweep RunFilter(const FilterOptions& options, const ProcessModel& model,
                      const std::vector<double>& theta, const FlockNoise& noise,
                      const FilterInput& input) {
  Check(noise.diffusion > 0, "a filter needs a positive diffusion");
  return Filter(options, model, theta, noise, input).Run();
}

}  // namespace flocklift
