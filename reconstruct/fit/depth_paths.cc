// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/depth_paths.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kSpacing = 0.7;  // of knots, in correlation times
constexpr double kJitter = 1e-8;  // added to K

// An animal from its first frame to its last.
struct Life {
  int first = 0, last = -1;
  bool errs = false;

  double Length(double dt) const { return std::max(0, last - first) * dt; }
  std::size_t Knots(double dt, double time) const {
    if (!errs) return 0;
    return 1 + static_cast<std::size_t>(std::ceil(Length(dt) / (kSpacing * time)));
  }
};

std::vector<Life> LivesOf(const DepthErrors& errors, const FilterInput& input) {
  Check(errors.time > 0 && errors.scale_sd >= 0, "depth errors last for a positive time");
  std::vector<Life> lives(static_cast<std::size_t>(input.animals()));
  int frame = input.first_frame();
  for (const auto& sightings : input.frames()) {
    for (const FilterInput::Sighting& sighting : sightings) {
      Life& life = lives[static_cast<std::size_t>(sighting.animal)];
      if (life.last < life.first) life.first = frame;
      life.last = frame;
      life.errs = life.errs || errors.own(sighting.animal, frame) > 0;
    }
    ++frame;
  }
  return lives;
}

class Knots {
 public:
  Knots(const Life& life, double dt, double time) : first_(life.first), dt_(dt), time_(time) {
    const auto count = static_cast<Eigen::Index>(life.Knots(dt, time));
    at_ = Eigen::VectorXd::Zero(count);
    if (count > 1) at_ = Eigen::VectorXd::LinSpaced(count, 0, life.Length(dt));
    Eigen::MatrixXd k(count, count);
    for (Eigen::Index a = 0; a < count; ++a) k.col(a) = Correlation(at_[a]);
    k.diagonal().array() += kJitter;
    root_ = Eigen::LLT<Eigen::MatrixXd>(k).matrixL();
  }

  std::size_t count() const { return static_cast<std::size_t>(at_.size()); }
  std::vector<double> Share(int frame) const {
    if (at_.size() == 0) return {};
    const Eigen::VectorXd share =
        root_.triangularView<Eigen::Lower>().solve(Correlation((frame - first_) * dt_));
    return {share.begin(), share.end()};
  }

 private:
  Eigen::VectorXd Correlation(double t) const {
    return (-0.5 * ((at_.array() - t) / time_).square()).exp();
  }

  int first_;
  double dt_, time_;
  Eigen::VectorXd at_;
  Eigen::MatrixXd root_;
};

}  // namespace

std::size_t UnknownDepthErrors(const DepthErrors& errors, const FilterInput& input) {
  std::size_t count = errors.scale_sd > 0 ? 1 : 0;
  for (const Life& life : LivesOf(errors, input)) count += life.Knots(input.dt(), errors.time);
  return count;
}

DepthPaths::DepthPaths(const DepthErrors& errors, const FilterInput& input)
    : size_(errors.scale_sd > 0 ? 1 : 0), scale_sd_(errors.scale_sd) {
  std::vector<std::size_t> first;
  std::vector<Knots> knots;
  for (const Life& life : LivesOf(errors, input)) {
    knots.emplace_back(life, input.dt(), errors.time);
    first.push_back(size_);
    size_ += knots.back().count();
  }
  int frame = input.first_frame();
  for (const auto& sightings : input.frames()) {
    std::vector<Part>& parts = frames_.emplace_back();
    for (const FilterInput::Sighting& sighting : sightings) {
      const auto animal = static_cast<std::size_t>(sighting.animal);
      parts.push_back({.first = first[animal],
                       .share = knots[animal].Share(frame),
                       .sight = errors.sight(sighting.animal, frame),
                       .own = errors.own(sighting.animal, frame)});
    }
    ++frame;
  }
}

double DepthPaths::Part::Error(std::span<const double> z) const {
  double e = 0;
  for (std::size_t m = 0; m < share.size(); ++m) e += share[m] * z[first + m];
  return own * e;
}

FilterInput DepthPaths::Without(const FilterInput& input, std::span<const double> z) const {
  Check(z.size() == size_ && input.frames().size() == frames_.size(),
        "depth errors are of these positions");
  const double scale = scale_sd_ > 0 ? scale_sd_ * z[0] : 0;
  std::vector<std::vector<FilterInput::Sighting>> moved = input.frames();
  for (std::size_t frame = 0; frame < moved.size(); ++frame) {
    for (std::size_t k = 0; k < moved[frame].size(); ++k) {
      const Part& part = frames_[frame][k];
      moved[frame][k].position -= (part.Error(z) + scale) * part.sight;
    }
  }
  return input.With(std::move(moved));
}

double DepthPaths::LogVolume(std::span<const double> z) const {
  double sum = 0, count = 0;
  for (const std::vector<Part>& parts : frames_) {
    for (const Part& part : parts) {
      const double left = 1 - part.Error(z);
      if (left <= 0) return -std::numeric_limits<double>::infinity();
      sum += 2 * std::log(left);
      count += 1;
    }
  }
  if (scale_sd_ > 0) {
    const double left = 1 - scale_sd_ * z[0];
    if (left <= 0) return -std::numeric_limits<double>::infinity();
    sum += 3 * count * std::log(left);
  }
  return sum;
}

void DepthPaths::AddVolume(std::span<const double> z, std::span<double> gradient,
                           std::span<double> second) const {
  double count = 0;
  for (const std::vector<Part>& parts : frames_) {
    for (const Part& part : parts) {
      count += 1;
      const double slope = part.own / (1 - part.Error(z));
      for (std::size_t a = 0; a < part.share.size(); ++a) {
        const double along = slope * part.share[a];
        gradient[part.first + a] += 2 * along;
        for (std::size_t b = 0; b < part.share.size(); ++b) {
          second[(part.first + a) * size_ + part.first + b] += 2 * along * slope * part.share[b];
        }
      }
    }
  }
  if (!(scale_sd_ > 0)) return;
  const double slope = scale_sd_ / (1 - scale_sd_ * z[0]);
  gradient[0] += 3 * count * slope;
  second[0] += 3 * count * slope * slope;
}

}  // namespace flocklift
