// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/marks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/camera/projection.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kNear = 0.01;      // nothing nearer is drawn [m]
constexpr double kPiecePx = 24;     // length of a piece, at most
constexpr double kDepthStep = 1.1;  // of the depths at a piece's ends, at most
constexpr int kMostHalvings = 14;
constexpr int kRimPoints = 60;

double HazeContrast(double depth, double haze) { return haze > 0 ? std::exp(-depth / haze) : 1; }

Paint PaintOf(const Color& color, double depth, double opacity, double haze) {
  return {{color.blue * Canvas::kUnit, color.green * Canvas::kUnit, color.red * Canvas::kUnit},
          depth,
          opacity * HazeContrast(depth, haze)};
}

std::optional<CoverageMask> MaskOf(const Silhouette& silhouette, const Camera& camera) {
  CoverageMask mask(BoundsOf(silhouette), camera.width, camera.height);
  if (mask.empty()) return std::nullopt;
  mask.Add(silhouette, 1);
  mask.Finish();
  return mask;
}

// Where a point in front of the camera is in the image; nothing when the lens has folded it there.
std::optional<Vec2d> Seen(const Camera& camera, const Vec3d& in_cam) {
  const Vec2d n{in_cam.x / in_cam.z, in_cam.y / in_cam.z};
  const Vec2d pixel = ProjectNormalized(camera.intrinsics, n);
  const auto& d = camera.intrinsics.distortion;
  if (std::all_of(d.begin(), d.end(), [](double c) { return c == 0; })) return pixel;
  const auto ray = RayThroughPixel(camera.intrinsics, pixel);
  if (!ray || std::hypot(ray->x - n.x, ray->y - n.y) > 1e-6) return std::nullopt;
  return pixel;
}

class LineCutter {
 public:
  LineCutter(const Stroke& stroke, const Camera& camera, double haze, std::vector<Patch>* pieces)
      : stroke_(stroke), camera_(camera), haze_(haze), pieces_(pieces) {}

  // Both ends in the camera frame.
  void Cut(Vec3d a, Vec3d b) {
    if (a.z > b.z) std::swap(a, b);
    if (!(b.z > kNear)) return;
    if (a.z < kNear) a = b + ((b.z - kNear) / (b.z - a.z)) * (a - b);
    Halve(a, b, kMostHalvings);
  }

 private:
  void Halve(const Vec3d& a, const Vec3d& b, int left) {
    const auto pa = Seen(camera_, a), pb = Seen(camera_, b);
    const bool seen = pa && pb;
    if (seen && IsOutside(*pa, *pb)) return;
    const bool is_short = seen && std::hypot(pb->x - pa->x, pb->y - pa->y) <= kPiecePx &&
                          std::max(a.z, b.z) <= kDepthStep * std::min(a.z, b.z);
    if (is_short) return Add(*pa, *pb, 0.5 * (a.z + b.z));
    if (left == 0) return;
    const Vec3d middle = 0.5 * (a + b);
    Halve(a, middle, left - 1);
    Halve(middle, b, left - 1);
  }

  // Both beyond the same side; the lens bends a line little enough for that.
  bool IsOutside(const Vec2d& a, const Vec2d& b) const {
    const double rim = stroke_.width_px + 2;
    return std::max(a.x, b.x) < -rim || std::min(a.x, b.x) > camera_.width + rim ||
           std::max(a.y, b.y) < -rim || std::min(a.y, b.y) > camera_.height + rim;
  }

  void Add(const Vec2d& a, const Vec2d& b, double depth) {
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (!(length > 0)) return;
    const double half = 0.5 * stroke_.width_px / length;
    const Vec2d side{-half * (b.y - a.y), half * (b.x - a.x)};
    ConvexPolygon piece;
    piece.Add({a.x + side.x, a.y + side.y});
    piece.Add({b.x + side.x, b.y + side.y});
    piece.Add({b.x - side.x, b.y - side.y});
    piece.Add({a.x - side.x, a.y - side.y});
    auto mask = MaskOf(UnionOf({&piece, 1}), camera_);
    if (!mask) return;
    pieces_->push_back({*std::move(mask), PaintOf(stroke_.color, depth, stroke_.opacity, haze_)});
  }

  const Stroke& stroke_;
  const Camera& camera_;
  double haze_;
  std::vector<Patch>* pieces_;
};

}  // namespace

std::vector<Stroke> GroundGrid(const Region& region, double spacing, Color color, double opacity) {
  Check(spacing > 0, "the spacing of a ground grid must be positive");
  const auto line = [&](const Vec3d& a, const Vec3d& b) {
    return Stroke{.points = {a, b}, .color = color, .width_px = 1, .opacity = opacity};
  };
  std::vector<Stroke> strokes;
  const Vec3d &low = region.low, &high = region.high;
  const double z = low.z;
  for (double x = std::ceil(low.x / spacing) * spacing; x <= high.x; x += spacing) {
    strokes.push_back(line({x, low.y, z}, {x, high.y, z}));
  }
  for (double y = std::ceil(low.y / spacing) * spacing; y <= high.y; y += spacing) {
    strokes.push_back(line({low.x, y, z}, {high.x, y, z}));
  }
  return strokes;
}

Stroke Ring(const Vec3d& center, double radius, const Vec3d& axis, Color color, double width_px,
            double opacity) {
  const Vec3d z = Normalized(axis);
  const Vec3d helper = std::abs(z.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d x = Normalized(Cross(helper, z)), y = Cross(z, x);
  Stroke ring{.points = {}, .color = color, .width_px = width_px, .opacity = opacity};
  for (int k = 0; k <= kRimPoints; ++k) {
    const double angle = 2 * std::numbers::pi * (k % kRimPoints) / kRimPoints;
    ring.points.push_back(center + radius * (std::cos(angle) * x + std::sin(angle) * y));
  }
  return ring;
}

std::vector<Stroke> BoxEdges(const Region& box, Color color, double width_px, double opacity) {
  const auto corner = [&](int k) {
    return Vec3d{(k & 1) != 0 ? box.high.x : box.low.x, (k & 2) != 0 ? box.high.y : box.low.y,
                 (k & 4) != 0 ? box.high.z : box.low.z};
  };
  std::vector<Stroke> edges;
  for (int from = 0; from < 8; ++from) {
    for (int bit = 1; bit < 8; bit *= 2) {
      if ((from & bit) != 0) continue;
      edges.push_back({.points = {corner(from), corner(from | bit)},
                       .color = color,
                       .width_px = width_px,
                       .opacity = opacity});
    }
  }
  return edges;
}

void AddStroke(const Stroke& stroke, const Camera& camera, const Rigid3d& cam_from_world,
               double haze, LineCover* cover, std::vector<Patch>* patches) {
  FLOCKLIFT_DCHECK(cover->size() == static_cast<std::size_t>(camera.width) *
                                        static_cast<std::size_t>(camera.height));
  std::vector<Patch> pieces;
  LineCutter cutter(stroke, camera, haze, &pieces);
  for (std::size_t k = 1; k < stroke.points.size(); ++k) {
    cutter.Cut(cam_from_world * stroke.points[k - 1], cam_from_world * stroke.points[k]);
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Patch& a, const Patch& b) { return a.paint.depth > b.paint.depth; });
  const auto at = [&](const CoverageMask& mask, int row) {
    return cover->data() +
           static_cast<std::size_t>(mask.top() + row) * static_cast<std::size_t>(camera.width) +
           mask.left();
  };
  // With c covered already, c' more is reached by laying c' / (1 - c) over what is there.
  for (Patch& piece : pieces) {
    for (int row = 0; row < piece.mask.height(); ++row) {
      float *share = piece.mask.Row(row), *before = at(piece.mask, row);
      for (int u = 0; u < piece.mask.width(); ++u) {
        const float open = 1 - before[u], added = std::min(share[u], open);
        before[u] += added;
        share[u] = open > 0 ? added / open : 0;
      }
    }
  }
  for (const Patch& piece : pieces) {
    for (int row = 0; row < piece.mask.height(); ++row) {
      std::fill_n(at(piece.mask, row), piece.mask.width(), 0.0F);
    }
  }
  for (Patch& piece : pieces) patches->push_back(std::move(piece));
}

void AddBall(const TintedBall& ball, const Camera& camera, const Rigid3d& cam_from_world,
             double haze, std::vector<Patch>* patches) {
  const Vec3d center = cam_from_world * ball.center;
  const double distance = Norm(center), radius = ball.radius;
  if (!(radius > 0) || !(center.z - radius > kNear)) return;
  // The cone of the lines of sight touches the ball on a circle.
  const double share = 1 - radius * radius / (distance * distance);
  const Stroke rim = Ring(share * center, radius * std::sqrt(share), center, {}, 1, 1);
  std::vector<Vec2d> outline;
  for (const Vec3d& point : rim.points) {
    const auto pixel = Seen(camera, point);
    if (!pixel) return;
    outline.push_back(*pixel);
  }
  const Vec2d middle = Project(camera.intrinsics, share * center);
  std::vector<ConvexPolygon> slices;
  constexpr std::size_t kStep = ConvexPolygon::kMaxCorners - 2;
  static_assert(kRimPoints % kStep == 0);
  for (std::size_t first = 0; first + kStep < outline.size(); first += kStep) {
    ConvexPolygon& slice = slices.emplace_back();
    slice.Add(middle);
    for (std::size_t k = first; k <= first + kStep; ++k) slice.Add(outline[k]);
  }
  auto mask = MaskOf(UnionOf(slices), camera);
  if (!mask) return;
  patches->push_back({*std::move(mask), PaintOf(ball.color, share * center.z, ball.opacity, haze)});
}

}  // namespace flocklift
