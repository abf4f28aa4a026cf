// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/tetra_morph.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr int kMostIterations = 60;

glm::dvec3 ToGlm(const Vec3d& v) { return {v.x, v.y, v.z}; }

glm::dmat3 EdgesFromFirst(const Tetra& t) {
  return {ToGlm(t[1] - t[0]), ToGlm(t[2] - t[0]), ToGlm(t[3] - t[0])};
}

double SquaredFrobenius(const glm::dmat3& m) {
  return glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
}

}  // namespace

PolarFactors PolarDecompose(const glm::dmat3& a) {
  glm::dmat3 r = a;
  for (int k = 0; k < kMostIterations; ++k) {
    const glm::dmat3 inverse = glm::transpose(glm::inverse(r));
    const double scale = std::sqrt(std::sqrt(SquaredFrobenius(inverse) / SquaredFrobenius(r)));
    const glm::dmat3 next = 0.5 * (scale * r + (1 / scale) * inverse);
    const double change = SquaredFrobenius(next - r);
    r = next;
    if (!(change > 1e-28)) break;
  }
  const glm::dmat3 s = glm::transpose(r) * a;
  return {r, 0.5 * (s + glm::transpose(s))};
}

glm::dmat3 AffineBetween(const Tetra& from, const Tetra& to) {
  return EdgesFromFirst(to) * glm::inverse(EdgesFromFirst(from));
}

Tetra MatchCorners(const Tetra& from, const Tetra& to) {
  const Vec3d centre = Centroid(from);
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  Tetra best = to;
  double most = -1e300;
  do {
    int inversions = 0;
    double sum = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      sum += Dot(from[a] - centre, to[order[a]]);
      for (std::size_t b = a + 1; b < 4; ++b) inversions += order[a] > order[b] ? 1 : 0;
    }
    if (inversions % 2 == 1 || sum <= most) continue;
    most = sum;
    for (std::size_t a = 0; a < 4; ++a) best[a] = to[order[a]];
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TetraMorph::TetraMorph(const Tetra& from, const Tetra& to) {
  const PolarFactors factors = PolarDecompose(AffineBetween(from, to));
  glm::dquat q = glm::normalize(glm::quat_cast(factors.rotation));
  if (q.w < 0) q = -q;
  const glm::dvec3 imaginary{q.x, q.y, q.z};
  const double sine = glm::length(imaginary);
  angle = 2 * std::atan2(sine, q.w);
  if (sine > 0) axis = imaginary / sine;
  stretch = factors.stretch;
}

glm::dmat3 TetraMorph::At(double t, MorphKind kind) const {
  const glm::dmat3 rotation = glm::mat3_cast(glm::angleAxis(t * angle, axis)), identity(1);
  return kind == MorphKind::kPublished ? (1 - t) * identity + t * (rotation * stretch)
                                       : rotation * ((1 - t) * identity + t * stretch);
}

Tetra TetraBetween(const Tetra& from, const Tetra& to, double t, MorphKind kind) {
  const glm::dmat3 a = TetraMorph(from, to).At(t, kind);
  const Vec3d first = (1 - t) * from[0] + t * to[0];
  Tetra result{first, first, first, first};
  for (std::size_t k = 1; k < 4; ++k) {
    const glm::dvec3 edge = a * ToGlm(from[k] - from[0]);
    result[k] += Vec3d{edge.x, edge.y, edge.z};
  }
  return result;
}

}  // namespace flocklift
