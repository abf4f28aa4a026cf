// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/spline_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// A system header, so that its warnings are not ours.
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr int kPieces = 4;  // of a segment, in the table of arc lengths

glm::dvec3 ToGlm(const Vec3d& v) { return {v.x, v.y, v.z}; }
Vec3d FromGlm(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// Weights of the four control points of a segment at t in [0, 1], and their derivatives.
glm::dvec4 Weights(double t) {
  const double r = 1 - t;
  return glm::dvec4(r * r * r, 3 * t * t * t - 6 * t * t + 4, 3 * r * r * r - 6 * r * r + 4,
                    t * t * t) /
         6.0;
}
glm::dvec4 WeightRates(double t) {
  const double r = 1 - t;
  return glm::dvec4(-r * r, 3 * t * t - 4 * t, -3 * r * r + 4 * r, t * t) / 2.0;
}

Vec3d Mix(const Vec3d* c, const glm::dvec4& w) {
  const glm::dmat4x3 points(ToGlm(c[0]), ToGlm(c[1]), ToGlm(c[2]), ToGlm(c[3]));
  return FromGlm(points * w);
}

}  // namespace

SplinePath::SplinePath(const std::vector<Vec3d>& control, bool closed) : closed_(closed) {
  Check(control.size() >= (closed ? 3 : 2), "a path needs two points, a closed one three");
  if (closed) {
    control_ = control;
    control_.insert(control_.end(), control.begin(), control.begin() + 3);
  } else {
    // One more at either end makes the curve pass through the first and the last.
    const std::size_t last = control.size() - 1;
    control_.push_back(2.0 * control[0] - control[1]);
    control_.insert(control_.end(), control.begin(), control.end());
    control_.push_back(2.0 * control[last] - control[last - 1]);
  }
  const int pieces = kPieces * static_cast<int>(control_.size() - 3);
  arc_.push_back(0);
  for (int k = 0; k < pieces; ++k) {
    const double u = static_cast<double>(k) / kPieces;
    arc_.push_back(arc_.back() + SegmentLength(u, u + 1.0 / kPieces));
  }
  Check(length() > 1e-9, "a path needs points at different places");
}

Vec3d SplinePath::Point(double u) const {
  const std::size_t k = std::min(static_cast<std::size_t>(u), control_.size() - 4);
  return Mix(&control_[k], Weights(u - static_cast<double>(k)));
}
Vec3d SplinePath::Derivative(double u) const {
  const std::size_t k = std::min(static_cast<std::size_t>(u), control_.size() - 4);
  return Mix(&control_[k], WeightRates(u - static_cast<double>(k)));
}

// Gauss-Legendre with five points.
double SplinePath::SegmentLength(double from, double to) const {
  constexpr double kNode[5] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                               -0.9061798459386640};
  constexpr double kWeight[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                 0.2369268850561891, 0.2369268850561891};
  double sum = 0;
  for (int k = 0; k < 5; ++k) {
    sum += kWeight[k] * Norm(Derivative(0.5 * (from + to) + 0.5 * (to - from) * kNode[k]));
  }
  return 0.5 * (to - from) * sum;
}

// The table gives the piece, bisection the place in it.
double SplinePath::ParameterAt(double s) const {
  s = closed_ ? s - length() * std::floor(s / length()) : std::clamp(s, 0.0, length());
  const auto after = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, s);
  const auto k = static_cast<double>(after - arc_.begin() - 1);
  const double start = k / kPieces, before = *(after - 1);
  double low = start, high = (k + 1) / kPieces;
  for (int round = 0; round < 50; ++round) {
    const double middle = 0.5 * (low + high);
    (before + SegmentLength(start, middle) < s ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Vec3d SplinePath::Position(double s) const { return Point(ParameterAt(s)); }

Vec3d SplinePath::Tangent(double s) const { return Normalized(Derivative(ParameterAt(s))); }

Rigid3d SplinePath::WorldFromPath(double s) const {
  const glm::dvec3 forward = ToGlm(Tangent(s));
  const glm::dvec3 across = glm::cross(glm::dvec3(0, 0, 1), forward);
  // On a vertical path +y of the world is the side.
  const glm::dvec3 left = glm::length(across) > 1e-9 ? glm::normalize(across) : glm::dvec3(0, 1, 0);
  const glm::dvec3 up = glm::cross(forward, left);
  const Rotation3d path_from_world =
      Rotation3d::FromRows(FromGlm(forward), FromGlm(left), FromGlm(up));
  return {path_from_world.Inverse(), Position(s)};
}

}  // namespace flocklift
