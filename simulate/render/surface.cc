// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/camera/projection.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kNear = 0.01;      // nothing nearer is drawn [m]
constexpr double kBend = 0.1;       // of an edge that is drawn straight, at most [px]
constexpr int kMostSplits = 24;     // of one triangle, halving an edge each
constexpr double kRimShare = 0.05;  // drawn beyond the rim of the view, of its size
constexpr int kRimSteps = 32;       // points on each side of the sensor

std::array<std::uint8_t, 3> Channels(const Color& color) {
  return {color.blue, color.green, color.red};
}

// The triangles by the row where their first corner is, so that those drawn one after the other
// touch the same memory: the depth buffer is far larger than a cache.
std::vector<std::uint32_t> ByRow(const Surface& surface, std::span<const ImageCorner> image,
                                 int height) {
  std::vector<std::uint32_t> order(surface.triangles.size());
  std::vector<std::uint32_t> first(static_cast<std::size_t>(height) + 2);
  const auto row_of = [&](std::size_t t) {
    const double v = image[surface.triangles[t][0]].pixel.y;
    return v > 0 ? static_cast<std::size_t>(std::min(v, double(height))) : 0;  // NaN: 0
  };
  for (std::size_t t = 0; t < order.size(); ++t) ++first[row_of(t) + 1];
  for (std::size_t row = 1; row < first.size(); ++row) first[row] += first[row - 1];
  for (std::size_t t = 0; t < order.size(); ++t) {
    order[first[row_of(t)]++] = static_cast<std::uint32_t>(t);
  }
  return order;
}

// How far the image of an edge is from the straight line, both at equal pace [px]. At the quarters
// too: about the optical axis the lens bends an edge into an S, whose middle is in its place.
double Bend(const Intrinsics& k, const Vec2d& a, const Vec2d& b) {
  const Vec2d pa = ProjectNormalized(k, a), pb = ProjectNormalized(k, b);
  double bend = 0;
  for (const double t : {0.25, 0.5, 0.75}) {
    const Vec2d p = ProjectNormalized(k, Vec2d{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
    bend =
        std::max(bend, std::hypot(p.x - pa.x - t * (pb.x - pa.x), p.y - pa.y - t * (pb.y - pa.y)));
  }
  return bend;
}

ImageCorner Middle(const ImageCorner& a, const ImageCorner& b) {
  return {{0.5 * (a.pixel.x + b.pixel.x), 0.5 * (a.pixel.y + b.pixel.y)},
          0.5 * (a.nearness + b.nearness),
          0.5 * (a.shade + b.shade)};
}

}  // namespace

// A corner in the camera frame.
struct SurfacePainter::Corner {
  Vec3d in_cam;
  double shade;
};

std::vector<std::array<std::uint32_t, 3>> TetrahedraFaces(std::size_t count) {
  std::vector<std::array<std::uint32_t, 3>> faces;
  faces.reserve(4 * count);
  for (std::uint32_t a = 0; a < 4 * count; a += 4) {
    faces.push_back({a, a + 2, a + 1});
    faces.push_back({a, a + 1, a + 3});
    faces.push_back({a, a + 3, a + 2});
    faces.push_back({a + 1, a + 2, a + 3});
  }
  return faces;
}

SurfacePainter::SurfacePainter(const Camera& camera) : camera_(camera) {
  Check(camera.width > 0 && camera.height > 0, "a camera without a size sees no surfaces");
  if (camera.KnowsGravity()) {
    light_ = {{0, 0, 1}, Normalized({-0.6, -0.3, 0.74})};
  } else {  // up is up in the image
    light_ = {{0, -1, 0}, Normalized({-0.6, -0.74, -0.3})};
  }
  const Intrinsics& k = camera.intrinsics;
  is_bent_ = std::any_of(k.distortion.begin(), k.distortion.end(), [](double d) { return d != 0; });
  low_ = {1e9, 1e9};
  high_ = {-1e9, -1e9};
  const auto include = [&](double u, double v) {
    const auto ray = RayThroughPixel(k, {u, v});
    if (!ray) return;
    low_ = {std::min(low_.x, ray->x), std::min(low_.y, ray->y)};
    high_ = {std::max(high_.x, ray->x), std::max(high_.y, ray->y)};
  };
  for (int step = 0; step <= kRimSteps; ++step) {
    const double share = static_cast<double>(step) / kRimSteps;
    const double u = share * camera.width - 0.5, v = share * camera.height - 0.5;
    include(u, -0.5);
    include(u, camera.height - 0.5);
    include(-0.5, v);
    include(camera.width - 0.5, v);
    include(u, v);
  }
  const Vec2d rim{kRimShare * (high_.x - low_.x), kRimShare * (high_.y - low_.y)};
  low_ = {low_.x - rim.x, low_.y - rim.y};
  high_ = {high_.x + rim.x, high_.y + rim.y};
  if (!is_bent_) return;
  // Outwards on circles, until one meets a fold.
  const double reach = std::hypot(std::max(-low_.x, high_.x), std::max(-low_.y, high_.y));
  for (int ring = 1; ring <= kRimSteps; ++ring) {
    const double radius = reach * ring / kRimSteps;
    for (int step = 0; step < kRimSteps; ++step) {
      const double angle = 2 * std::numbers::pi * step / kRimSteps;
      if (IsFolded({radius * std::cos(angle), radius * std::sin(angle)})) return;
    }
    safe_radius_ = radius * std::cos(std::numbers::pi / kRimSteps);
  }
}

bool SurfacePainter::IsFolded(const Vec2d& n) const {
  if (!is_bent_ || std::hypot(n.x, n.y) <= safe_radius_) return false;
  const auto ray = RayThroughPixel(camera_.intrinsics, ProjectNormalized(camera_.intrinsics, n));
  return !ray || std::hypot(ray->x - n.x, ray->y - n.y) > 1e-6;
}

double SurfacePainter::Shade(const Vec3d& normal) const {
  return 0.35 + 0.125 * (1 + Dot(normal, light_.up)) + 0.5 * std::max(0.0, Dot(normal, light_.sun));
}

void SurfacePainter::Draw(const Surface& surface, const Rigid3d& cam_from_world, double shutter,
                          DepthBuffer* out) const {
  const std::size_t count = surface.triangles.size();
  Check(surface.tones.size() == 1 || surface.tones.size() == count,
        "a surface has one tone, or one for each triangle");
  Check(surface.normals.empty() || surface.normals.size() == 3 * count,
        "a surface has three normals for each triangle, or none");
  Check(surface.velocities.empty() || surface.velocities.size() == surface.vertices.size(),
        "a surface has a velocity for each vertex, or none");
  if (surface.velocities.empty() || !(shutter > 0)) {
    DrawMoment(surface, cam_from_world, 0, DepthBuffer::kAllSamples, out);
    return;
  }
  // In an order that scatters the moments over the pixel.
  constexpr std::array<int, DepthBuffer::kSamples> kMoment{1, 3, 0, 2};
  for (int s = 0; s < DepthBuffer::kSamples; ++s) {
    const double share = (kMoment[static_cast<std::size_t>(s)] + 0.5) / DepthBuffer::kSamples - 0.5;
    DrawMoment(surface, cam_from_world, share * shutter, 1U << s, out);
  }
}

void SurfacePainter::DrawMoment(const Surface& surface, const Rigid3d& cam_from_world,
                                double offset, unsigned samples, DepthBuffer* out) const {
  const Vec3d viewer = cam_from_world.Inverse().translation;
  std::vector<Vec3d> in_world(surface.vertices.begin(), surface.vertices.end());
  if (offset != 0) {
    for (std::size_t k = 0; k < in_world.size(); ++k) in_world[k] += offset * surface.velocities[k];
  }
  std::vector<Vec3d> in_cam(in_world.size());
  std::vector<ImageCorner> image(in_world.size());
  for (std::size_t k = 0; k < in_world.size(); ++k) {
    in_cam[k] = cam_from_world * in_world[k];
    if (is_bent_ || !(in_cam[k].z > kNear)) continue;
    image[k] = {Project(camera_.intrinsics, in_cam[k]), 1 / in_cam[k].z, 1};
  }
  for (const std::uint32_t t : ByRow(surface, image, camera_.height)) {
    const auto& [ia, ib, ic] = surface.triangles[t];
    const auto& [za, zb, zc] = std::array{in_cam[ia].z, in_cam[ib].z, in_cam[ic].z};
    if (std::max({za, zb, zc}) <= kNear) continue;
    const Vec3d across = Cross(in_world[ib] - in_world[ia], in_world[ic] - in_world[ia]);
    const double side = Dot(across, viewer - in_world[ia]) < 0 ? -1 : 1;
    if (surface.is_closed && side < 0) continue;
    std::array<double, 3> shade;
    if (surface.normals.empty()) {
      shade.fill(Shade(side * Normalized(across)));
    } else {
      for (std::size_t c = 0; c < 3; ++c) {
        shade[c] = Shade(side * surface.normals[3 * std::size_t{t} + c]);
      }
    }
    const auto tone = Channels(surface.tones[surface.tones.size() == 1 ? 0 : t]);
    if (!is_bent_ && std::min({za, zb, zc}) > kNear) {
      std::array<ImageCorner, 3> corners{image[ia], image[ib], image[ic]};
      for (std::size_t c = 0; c < 3; ++c) corners[c].shade = shade[c];
      out->Draw(corners, tone, samples);
    } else {
      DrawClipped({{{in_cam[ia], shade[0]}, {in_cam[ib], shade[1]}, {in_cam[ic], shade[2]}}}, tone,
                  samples, out);
    }
  }
}

// Sutherland and Hodgman (1974): one plane after the other.
void SurfacePainter::DrawClipped(const std::array<Corner, 3>& corners,
                                 const std::array<std::uint8_t, 3>& tone, unsigned samples,
                                 DepthBuffer* out) const {
  const auto height_over = [&](int plane, const Vec3d& p) {
    switch (plane) {
      case 0:
        return p.z - kNear;
      case 1:
        return p.x - low_.x * p.z;
      case 2:
        return high_.x * p.z - p.x;
      case 3:
        return p.y - low_.y * p.z;
      default:
        return high_.y * p.z - p.y;
    }
  };
  std::vector<Corner> polygon(corners.begin(), corners.end()), kept;
  for (int plane = 0; plane < 5; ++plane) {
    kept.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Corner &here = polygon[k], &next = polygon[(k + 1) % polygon.size()];
      const double a = height_over(plane, here.in_cam), b = height_over(plane, next.in_cam);
      if (a >= 0) kept.push_back(here);
      if ((a >= 0) == (b >= 0)) continue;
      // From the inner end, so that both triangles at an edge cut it at the same point.
      const Corner &inner = a >= 0 ? here : next, &outer = a >= 0 ? next : here;
      const double share = std::max(a, b) / (std::max(a, b) - std::min(a, b));
      kept.push_back({inner.in_cam + share * (outer.in_cam - inner.in_cam),
                      inner.shade + share * (outer.shade - inner.shade)});
    }
    std::swap(polygon, kept);
    if (polygon.size() < 3) return;
  }
  std::vector<ImageCorner> flat;
  for (const Corner& corner : polygon) {
    const Vec3d& p = corner.in_cam;
    flat.push_back({{p.x / p.z, p.y / p.z}, 1 / p.z, corner.shade});
  }
  for (std::size_t k = 2; k < flat.size(); ++k) {
    DrawBent({flat[0], flat[k - 1], flat[k]}, tone, samples, kMostSplits, out);
  }
}

// `corners` in normalised coordinates, where edges are straight and nearness and shade linear. The
// longest bent edge is halved; whether an edge is bent depends on it alone, so neighbours stay
// together.
void SurfacePainter::DrawBent(const std::array<ImageCorner, 3>& corners,
                              const std::array<std::uint8_t, 3>& tone, unsigned samples, int splits,
                              DepthBuffer* out) const {
  const Intrinsics& k = camera_.intrinsics;
  std::array<ImageCorner, 3> bent = corners;
  for (ImageCorner& corner : bent) corner.pixel = ProjectNormalized(k, corner.pixel);
  if (is_bent_) {
    double longest = 0;
    int edge = -1;
    for (int e = 0; e < 3 && splits > 0; ++e) {
      const Vec2d &a = corners[static_cast<std::size_t>(e)].pixel,
                  &b = corners[static_cast<std::size_t>((e + 1) % 3)].pixel;
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      if (length > longest && Bend(k, a, b) > kBend) {
        longest = length;
        edge = e;
      }
    }
    if (edge >= 0) {
      const auto a = static_cast<std::size_t>(edge), b = static_cast<std::size_t>((edge + 1) % 3);
      const auto c = static_cast<std::size_t>((edge + 2) % 3);
      const ImageCorner middle = Middle(corners[a], corners[b]);
      DrawBent({corners[a], middle, corners[c]}, tone, samples, splits - 1, out);
      DrawBent({middle, corners[b], corners[c]}, tone, samples, splits - 1, out);
      return;
    }
    for (const ImageCorner& corner : corners) {
      if (IsFolded(corner.pixel)) return;
    }
  }
  out->Draw(bent, tone, samples);
}

}  // namespace flocklift
