// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/camera_path.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>

namespace flocklift::internal {
namespace {

struct Place {
  std::size_t interval = 0;
  double fraction = 0;
};

Place PlaceAt(double time, double interval, std::size_t controls) {
  const double position = time / interval;
  const double last = static_cast<double>(controls) - 4;  // of the intervals
  const double left = std::clamp(std::floor(position), 0.0, last);
  return {static_cast<std::size_t>(left), std::clamp(position - left, 0.0, 1.0)};
}

}  // namespace

CameraPath::CameraPath(const std::vector<Vec3d>& places, double fps, double knot_interval)
    : interval_(knot_interval) {
  if (places.empty()) return;
  if (places.size() == 1) {
    controls_.assign(4, places[0]);
    return;
  }
  const double duration = static_cast<double>(places.size() - 1) / fps;
  const auto intervals =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(duration / knot_interval)));
  const std::size_t count = intervals + 3;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(count), 3);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Place place = PlaceAt(static_cast<double>(k) / fps, interval_, count);
    const std::array<double, 4> weights = SplineWeights(place.fraction);
    for (std::size_t a = 0; a < 4; ++a) {
      const auto row = static_cast<Eigen::Index>(place.interval + a);
      right.row(row) += weights[a] * Eigen::RowVector3d(places[k].x, places[k].y, places[k].z);
      for (std::size_t b = 0; b < 4; ++b) {
        entries.emplace_back(row, static_cast<Eigen::Index>(place.interval + b),
                             weights[a] * weights[b]);
      }
    }
  }
  // Second differences next to nothing: they decide only what the frames leave open.
  constexpr double kStiffness = 1e-9;
  constexpr std::array<double, 3> kDifference = {1, -2, 1};
  for (std::size_t k = 0; k + 2 < count; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        entries.emplace_back(static_cast<Eigen::Index>(k + a), static_cast<Eigen::Index>(k + b),
                             kStiffness * kDifference[a] * kDifference[b]);
      }
    }
  }
  Eigen::SparseMatrix<double> normal(static_cast<Eigen::Index>(count),
                                     static_cast<Eigen::Index>(count));
  normal.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
  const Eigen::MatrixX3d controls = solver.solve(right);
  for (Eigen::Index k = 0; k < controls.rows(); ++k) {
    controls_.push_back({controls(k, 0), controls(k, 1), controls(k, 2)});
  }
}

CameraMotion CameraPath::At(double time) const {
  CameraMotion motion;
  if (!moves()) return motion;
  const Place place = PlaceAt(time, interval_, controls_.size());
  const std::array<double, 4> weights = SplineWeights(place.fraction);
  const std::array<double, 4> slopes = SplineSlopes(place.fraction);
  const std::array<double, 4> curves = SplineCurves(place.fraction);
  motion.moves = true;
  for (std::size_t a = 0; a < 4; ++a) {
    const Vec3d& control = controls_[place.interval + a];
    motion.place += weights[a] * control;
    motion.velocity += (slopes[a] / interval_) * control;
    motion.acceleration += (curves[a] / (interval_ * interval_)) * control;
  }
  return motion;
}

}  // namespace flocklift::internal
