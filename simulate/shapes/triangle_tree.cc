// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr std::size_t kStack = 128;  // deeper than any tree that halves its triangles

Vec3d Least(const Vec3d& a, const Vec3d& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vec3d Most(const Vec3d& a, const Vec3d& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

double SquaredDistanceToBox(const Vec3d& p, const Vec3d& low, const Vec3d& high) {
  return SquaredNorm(p - Most(low, Least(p, high)));
}

// Whether the segment's part before `end` touches the box (grown a little, against round-off).
bool MeetsBox(const Vec3d& from, const Vec3d& way, double end, const Vec3d& low,
              const Vec3d& high) {
  double enter = 0, leave = end;
  const auto slab = [&](double start, double along, double a, double b) {
    const double slack = 1e-12 + 1e-9 * (b - a);
    a -= slack;
    b += slack;
    if (along == 0) {
      if (start < a || start > b) leave = -1;
      return;
    }
    double s = (a - start) / along, t = (b - start) / along;
    if (s > t) std::swap(s, t);
    enter = std::max(enter, s);
    leave = std::min(leave, t);
  };
  slab(from.x, way.x, low.x, high.x);
  slab(from.y, way.y, low.y, high.y);
  slab(from.z, way.z, low.z, high.z);
  return enter <= leave + 1e-9;
}

// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
std::optional<double> HitTriangle(const Vec3d& from, const Vec3d& way, const Vec3d& a,
                                  const Vec3d& b, const Vec3d& c) {
  constexpr double kRim = 1e-9;  // a hit of the rim counts for both neighbours
  const Vec3d ab = b - a, ac = c - a, across = Cross(way, ac);
  const double determinant = Dot(ab, across);
  if (determinant == 0) return std::nullopt;
  const Vec3d offset = from - a, other = Cross(offset, ab);
  const double u = Dot(offset, across) / determinant, v = Dot(way, other) / determinant;
  if (u < -kRim || v < -kRim || u + v > 1 + kRim) return std::nullopt;
  const double s = Dot(ac, other) / determinant;
  if (!(s >= 0 && s <= 1)) return std::nullopt;
  return s;
}

}  // namespace

// By the regions of the plane that are nearest to a corner, an edge or the inside (Ericson,
// Real-Time Collision Detection, 2005, section 5.1.5).
Vec3d NearestOnTriangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a;
  const double d1 = Dot(ab, p - a), d2 = Dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = Dot(ab, p - b), d4 = Dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double d5 = Dot(ab, p - c), d6 = Dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;  // no area: its edges were tried
  return a + vb / sum * ab + vc / sum * ac;
}

TriangleTree::TriangleTree(TriangleMesh surface) : surface_(std::move(surface)) {
  Check(!surface_.triangles.empty(), "a surface needs triangles");
  order_.resize(surface_.triangles.size());
  std::iota(order_.begin(), order_.end(), 0U);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    centroid_.push_back((surface_.Corner(k, 0) + surface_.Corner(k, 1) + surface_.Corner(k, 2)) /
                        3.0);
  }
  root_ = Build(0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t TriangleTree::Build(std::uint32_t first, std::uint32_t last) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Node node{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}, first, last, last - first <= kLeafSize};
  Vec3d low = node.low, high = node.high;  // of the centroids
  for (std::uint32_t k = first; k < last; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      node.low = Least(node.low, surface_.Corner(order_[k], c));
      node.high = Most(node.high, surface_.Corner(order_[k], c));
    }
    low = Least(low, centroid_[order_[k]]);
    high = Most(high, centroid_[order_[k]]);
  }
  if (!node.leaf) {
    const Vec3d size = high - low;
    const auto key = [&](std::uint32_t k) {
      const Vec3d& p = centroid_[k];
      return size.x >= size.y && size.x >= size.z ? p.x : size.y >= size.z ? p.y : p.z;
    };
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return std::pair(key(a), a) < std::pair(key(b), b);
                     });
    node.first = Build(first, middle);
    node.last = Build(middle, last);
  }
  nodes_.push_back(node);
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

TriangleTree::Nearest TriangleTree::NearestPoint(const Vec3d& p) const {
  Nearest best;
  struct Open {
    double squared_distance;
    std::uint32_t node;
  };
  std::array<Open, kStack> stack;
  std::size_t open = 0;
  const auto push = [&](std::uint32_t node) {
    stack[open++] = {SquaredDistanceToBox(p, nodes_[node].low, nodes_[node].high), node};
  };
  push(root_);
  while (open > 0) {
    const Open top = stack[--open];
    if (top.squared_distance > best.squared_distance) continue;
    const Node& node = nodes_[top.node];
    if (!node.leaf) {
      push(node.first);
      push(node.last);
      if (stack[open - 1].squared_distance > stack[open - 2].squared_distance) {
        std::swap(stack[open - 1], stack[open - 2]);
      }
      continue;
    }
    for (std::uint32_t k = node.first; k < node.last; ++k) {
      const std::uint32_t triangle = order_[k];
      const Vec3d point =
          NearestOnTriangle(p, surface_.Corner(triangle, 0), surface_.Corner(triangle, 1),
                            surface_.Corner(triangle, 2));
      const double squared = SquaredNorm(point - p);
      if (squared < best.squared_distance ||
          (squared == best.squared_distance && triangle < best.triangle)) {
        best = {triangle, point, squared};
      }
    }
  }
  return best;
}

std::optional<double> TriangleTree::FirstHit(const Vec3d& from, const Vec3d& to) const {
  const Vec3d way = to - from;
  std::optional<double> best;
  std::array<std::uint32_t, kStack> stack;
  std::size_t open = 0;
  stack[open++] = root_;
  while (open > 0) {
    const Node& node = nodes_[stack[--open]];
    if (!MeetsBox(from, way, best.value_or(1), node.low, node.high)) continue;
    if (!node.leaf) {
      stack[open++] = node.first;
      stack[open++] = node.last;
      continue;
    }
    for (std::uint32_t k = node.first; k < node.last; ++k) {
      const std::uint32_t triangle = order_[k];
      const auto hit = HitTriangle(from, way, surface_.Corner(triangle, 0),
                                   surface_.Corner(triangle, 1), surface_.Corner(triangle, 2));
      if (hit && (!best || *hit < *best)) best = hit;
    }
  }
  return best;
}

}  // namespace flocklift
