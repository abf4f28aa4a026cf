// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/successors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// FLANN's templates convert between integers as they please.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#include <flann/flann.hpp>
#pragma GCC diagnostic pop

namespace flocklift {
namespace {

constexpr int kDimensions = 5;
constexpr double kVelocityFrames = 1;  // w: a difference in velocity, over so many frames

using Point = std::array<double, kDimensions>;

}  // namespace

class Successors::Tree {
 public:
  Tree(std::span<const TrackEnd> beginnings, double speed) : speed_(std::max(speed, 0.1)) {
    for (const TrackEnd& b : beginnings) points_.push_back(PointOf(b.frame, b.state));
    if (points_.empty()) return;
    index_ = std::make_unique<Index>(
        flann::Matrix<double>(points_[0].data(), points_.size(), kDimensions),
        flann::KDTreeSingleIndexParams(12));
    index_->buildIndex();
  }

  Point PointOf(double frame, const MotionState& s) const {
    return {speed_ * frame, s.position.x, s.position.y, kVelocityFrames * s.velocity.x,
            kVelocityFrames * s.velocity.y};
  }

  void Find(Point at, double radius, std::vector<int>* found) const {
    if (!index_) return;
    std::vector<std::vector<std::size_t>> indices;
    std::vector<std::vector<double>> distances;
    flann::SearchParams all(flann::FLANN_CHECKS_UNLIMITED);
    all.sorted = false;
    // L2 in FLANN is squared; a little more, because it takes the radius as a float.
    index_->radiusSearch(flann::Matrix<double>(at.data(), 1, kDimensions), indices, distances,
                         static_cast<float>(1.0001 * radius * radius), all);
    for (const std::size_t k : indices[0]) found->push_back(static_cast<int>(k));
  }

  double speed() const { return speed_; }

 private:
  using Index = flann::KDTreeSingleIndex<flann::L2_Simple<double>>;

  double speed_;
  std::vector<Point> points_;
  std::unique_ptr<Index> index_;
};

Successors::Successors(std::span<const TrackEnd> beginnings, double speed)
    : tree_(std::make_unique<Tree>(beginnings, speed)) {}
Successors::~Successors() = default;

std::vector<int> Successors::Find(const TrackEnd& end, int max_gap,
                                  const std::function<double(int gap)>& reach,
                                  double speed_reach) const {
  std::vector<int> found;
  const double own_speed = std::hypot(end.state.velocity.x, end.state.velocity.y);
  for (int first = 1; first <= max_gap; first *= 2) {
    const int last = std::min(2 * first - 1, max_gap);
    const double middle = 0.5 * (first + last), half = 0.5 * (last - first);
    MotionState ahead = end.state;
    ahead.position.x += middle * ahead.velocity.x;
    ahead.position.y += middle * ahead.velocity.y;
    const double place = reach(last) + half * own_speed;
    const double radius =
        std::hypot(tree_->speed() * half, place, kVelocityFrames * speed_reach) + 1e-6;
    tree_->Find(tree_->PointOf(end.frame + middle, ahead), radius, &found);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace flocklift
