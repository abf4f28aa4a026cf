// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/silhouette.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace flocklift {
namespace {

// A side of a polygon that is not horizontal: x = x_top + slope (y - top).
struct Edge {
  double top, bottom, x_top, slope;
  double left, right;  // bounds

  double At(double y) const { return x_top + slope * (y - top); }
};

// A polygon: its edges [first, last), and its bounds. A sweep from top to bottom takes the edges in
// `order` (offsets from `first`), of which `begun` have begun and those in `active` go on.
struct Piece {
  std::size_t first, last;
  double left, right, top, bottom;
  std::array<std::uint8_t, ConvexPolygon::kMaxCorners> order{}, active{};
  int begun = 0, active_count = 0;

  bool MayMeet(const Piece& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

struct Outline {
  std::vector<Edge> edges;
  std::vector<Piece> pieces;
};

struct Interval {
  double left, right;  // in the middle of the strip
  std::size_t left_edge, right_edge;
};

// Fills `order`: by increasing top.
void Order(const std::vector<Edge>& edges, Piece* piece) {
  const Edge* const mine = edges.data() + piece->first;
  for (std::size_t i = 0; i < piece->last - piece->first; ++i) {
    std::size_t k = i;
    for (; k > 0 && mine[i].top < mine[piece->order[k - 1]].top; --k) {
      piece->order[k] = piece->order[k - 1];
    }
    piece->order[k] = static_cast<std::uint8_t>(i);
  }
}

Outline OutlineOf(std::span<const ConvexPolygon> polygons) {
  Outline outline;
  outline.edges.reserve(polygons.size() * ConvexPolygon::kMaxCorners);
  outline.pieces.reserve(polygons.size());
  for (const ConvexPolygon& polygon : polygons) {
    if (polygon.corners == 0) continue;
    const Vec2d start = polygon.corner[0];
    Piece piece{outline.edges.size(), 0, start.x, start.x, start.y, start.y};
    for (int k = 0; k < polygon.corners; ++k) {
      Vec2d a = polygon.corner[static_cast<std::size_t>(k)];
      Vec2d b = polygon.corner[static_cast<std::size_t>(k + 1 < polygon.corners ? k + 1 : 0)];
      piece.left = std::min(piece.left, a.x);
      piece.right = std::max(piece.right, a.x);
      piece.top = std::min(piece.top, a.y);
      piece.bottom = std::max(piece.bottom, a.y);
      if (a.y == b.y) continue;
      if (a.y > b.y) std::swap(a, b);
      outline.edges.push_back(
          {a.y, b.y, a.x, (b.x - a.x) / (b.y - a.y), std::min(a.x, b.x), std::max(a.x, b.x)});
    }
    piece.last = outline.edges.size();
    Order(outline.edges, &piece);
    outline.pieces.push_back(piece);
  }
  return outline;
}

void AddCrossings(const Outline& outline, const Piece& p, const Piece& q,
                  std::vector<double>* bounds) {
  for (std::size_t i = p.first; i < p.last; ++i) {
    const Edge& a = outline.edges[i];
    if (a.top >= q.bottom || a.bottom <= q.top || a.left > q.right || a.right < q.left) continue;
    for (std::size_t j = q.first; j < q.last; ++j) {
      const Edge& b = outline.edges[j];
      // One branch, rarely taken: where they are is hard to predict one by one.
      if (((a.top < b.bottom) & (b.top < a.bottom) & (a.left <= b.right) & (b.left <= a.right)) ==
          0) {
        continue;
      }
      const double top = std::max(a.top, b.top), bottom = std::min(a.bottom, b.bottom);
      const double gap_at_top = a.At(top) - b.At(top), gap_at_bottom = a.At(bottom) - b.At(bottom);
      if ((gap_at_top < 0) == (gap_at_bottom < 0)) continue;
      bounds->push_back(top + (bottom - top) * gap_at_top / (gap_at_top - gap_at_bottom));
    }
  }
}

// Heights at which the order of the edges along x, or their number, may change.
std::vector<double> StripBounds(const Outline& outline) {
  std::vector<double> bounds;
  bounds.reserve(4 * outline.edges.size());
  // Every corner is the top of an edge or the bottom of its polygon.
  for (const Piece& piece : outline.pieces) {
    for (std::size_t k = 0; k < piece.last - piece.first; ++k) {
      const double top = outline.edges[piece.first + piece.order[k]].top;
      if (k == 0 || top != bounds.back()) bounds.push_back(top);
    }
    bounds.push_back(piece.bottom);
  }
  for (std::size_t p = 0; p < outline.pieces.size(); ++p) {
    for (std::size_t q = p + 1; q < outline.pieces.size(); ++q) {
      if (outline.pieces[p].MayMeet(outline.pieces[q])) {
        AddCrossings(outline, outline.pieces[p], outline.pieces[q], &bounds);
      }
    }
  }
  std::sort(bounds.begin(), bounds.end());
  return bounds;
}

// Moves the sweep of a piece down to y, which must not be above where it was.
void Advance(const std::vector<Edge>& edges, double y, Piece* piece) {
  const Edge* const mine = edges.data() + piece->first;
  auto& active = piece->active;
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  int kept = 0;
  for (int k = 0; k < piece->active_count; ++k) {
    if (mine[active[at(k)]].bottom > y) active[at(kept++)] = active[at(k)];
  }
  const int count = static_cast<int>(piece->last - piece->first);
  for (; piece->begun < count; ++piece->begun) {
    const std::uint8_t edge = piece->order[at(piece->begun)];
    if (mine[edge].top > y) break;
    if (mine[edge].bottom <= y) continue;
    int k = kept++;  // by their place in the polygon
    for (; k > 0 && edge < active[at(k - 1)]; --k) active[at(k)] = active[at(k - 1)];
    active[at(k)] = edge;
  }
  piece->active_count = kept;
}

// The interval of each polygon at height y, by increasing left end.
void IntervalsAt(double y, Outline* outline, std::vector<Interval>* intervals) {
  intervals->clear();
  for (Piece& piece : outline->pieces) {
    if (y < piece.top || y >= piece.bottom) continue;
    Advance(outline->edges, y, &piece);
    if (piece.active_count < 2) continue;
    const std::size_t a = piece.first + piece.active[0], b = piece.first + piece.active[1];
    const double x_a = outline->edges[a].At(y), x_b = outline->edges[b].At(y);
    const Interval added = x_b < x_a ? Interval{x_b, x_a, b, a} : Interval{x_a, x_b, a, b};
    // A handful: insertion is the fastest order.
    intervals->push_back(added);
    std::size_t k = intervals->size() - 1;
    for (; k > 0 && added.left < (*intervals)[k - 1].left; --k) {
      (*intervals)[k] = (*intervals)[k - 1];
    }
    (*intervals)[k] = added;
  }
}

// A trapezoid that goes on as long as it ends on the same two edges.
struct Open {
  std::size_t left_edge, right_edge;
  double top;
};

Trapezoid Between(const Outline& outline, const Open& open, double bottom) {
  const Edge& left = outline.edges[open.left_edge];
  const Edge& right = outline.edges[open.right_edge];
  return {open.top,           bottom,          left.At(open.top), left.At(bottom),
          right.At(open.top), right.At(bottom)};
}

}  // namespace

void Silhouette::Shift(const Vec2d& offset) {
  for (Trapezoid& t : trapezoids) {
    t.top += offset.y;
    t.bottom += offset.y;
    t.left_at_top += offset.x;
    t.left_at_bottom += offset.x;
    t.right_at_top += offset.x;
    t.right_at_bottom += offset.x;
  }
}

Silhouette UnionOf(std::span<const ConvexPolygon> polygons) {
  Outline outline = OutlineOf(polygons);
  const std::vector<double> bounds = StripBounds(outline);
  Silhouette silhouette;
  std::vector<Interval> intervals;
  std::vector<Open> open, still_open;
  for (std::size_t k = 1; k < bounds.size(); ++k) {
    const double top = bounds[k - 1], bottom = bounds[k];
    const double middle = 0.5 * (top + bottom);
    if (!(top < middle && middle < bottom)) continue;
    IntervalsAt(middle, &outline, &intervals);
    still_open.clear();
    for (std::size_t i = 0; i < intervals.size();) {
      Interval merged = intervals[i];
      for (++i; i < intervals.size() && intervals[i].left <= merged.right; ++i) {
        if (intervals[i].right <= merged.right) continue;
        merged.right = intervals[i].right;
        merged.right_edge = intervals[i].right_edge;
      }
      const auto same = std::find_if(open.begin(), open.end(), [&](const Open& o) {
        return o.left_edge == merged.left_edge && o.right_edge == merged.right_edge;
      });
      const double started = same != open.end() ? same->top : top;
      still_open.push_back({merged.left_edge, merged.right_edge, started});
      if (same != open.end()) open.erase(same);
    }
    for (const Open& o : open) silhouette.trapezoids.push_back(Between(outline, o, top));
    std::swap(open, still_open);
  }
  for (const Open& o : open) silhouette.trapezoids.push_back(Between(outline, o, bounds.back()));
  return silhouette;
}

SilhouetteMoments MomentsOf(const Silhouette& silhouette) {
  if (silhouette.trapezoids.empty()) return {};
  // About a point nearby, so that no digits are lost far from the origin.
  const Vec2d origin{silhouette.trapezoids.front().left_at_top, silhouette.trapezoids.front().top};
  double area = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (const Trapezoid& t : silhouette.trapezoids) {
    // All integrands are cubics of y at most: Simpson's rule is exact.
    for (int node = 0; node < 3; ++node) {
      const double share = 0.5 * node;
      const double weight = (t.bottom - t.top) * (node == 1 ? 4.0 : 1.0) / 6.0;
      const double height = t.top + share * (t.bottom - t.top) - origin.y;
      const double left = t.left_at_top + share * (t.left_at_bottom - t.left_at_top) - origin.x;
      const double right = t.right_at_top + share * (t.right_at_bottom - t.right_at_top) - origin.x;
      const double length = right - left;
      const double first = 0.5 * (right * right - left * left);
      area += weight * length;
      x += weight * first;
      y += weight * height * length;
      xx += weight * (right * right * right - left * left * left) / 3;
      xy += weight * height * first;
      yy += weight * height * height * length;
    }
  }
  if (!(area > 0)) return {};
  SilhouetteMoments m{.area = area, .centroid = {x / area, y / area}};
  m.xx = std::max(0.0, xx / area - m.centroid.x * m.centroid.x);
  m.xy = xy / area - m.centroid.x * m.centroid.y;
  m.yy = std::max(0.0, yy / area - m.centroid.y * m.centroid.y);
  m.centroid.x += origin.x;
  m.centroid.y += origin.y;
  return m;
}

Shape ShapeOf(const SilhouetteMoments& m) {
  const double mean = 0.5 * (m.xx + m.yy);
  const double half_gap = std::hypot(0.5 * (m.xx - m.yy), m.xy);
  double angle_deg = 0.5 * std::atan2(2 * m.xy, m.xx - m.yy) * 180 / std::numbers::pi;
  if (angle_deg < 0) angle_deg += 180;
  if (angle_deg >= 180) angle_deg -= 180;
  return {.major = 4 * std::sqrt(mean + half_gap),
          .minor = 4 * std::sqrt(std::max(0.0, mean - half_gap)),
          .angle_deg = angle_deg,
          .area = m.area};
}

Box BoundsOf(const Silhouette& silhouette) {
  if (silhouette.trapezoids.empty()) return {};
  const Trapezoid& first = silhouette.trapezoids.front();
  double left = first.left_at_top, right = first.right_at_top;
  double top = first.top, bottom = first.bottom;
  for (const Trapezoid& t : silhouette.trapezoids) {
    left = std::min({left, t.left_at_top, t.left_at_bottom});
    right = std::max({right, t.right_at_top, t.right_at_bottom});
    top = std::min(top, t.top);
    bottom = std::max(bottom, t.bottom);
  }
  return {left, top, right - left, bottom - top};
}

}  // namespace flocklift
