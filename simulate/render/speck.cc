// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/speck.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/camera/projection.h"

namespace flocklift {
namespace {

constexpr double kPi = std::numbers::pi;

// The table's grid. The solid is the same from opposite directions, and its sides are mirror
// images: a quarter of the sphere is enough. Seen edge-on the wings' area has a kink, so the
// elevations crowd there: sin(elevation) = (k / kElevations)^2.
constexpr int kElevations = 12, kAzimuths = 16, kPhases = 16;
constexpr double kRatioStep = 1.2;                     // between tables
constexpr int kLowestRatio = -26, kHighestRatio = 26;  // as powers of kRatioStep: 0.009 to 114

double ExactArea(const Animal& animal, const Vec3d& to_viewer) {
  const double far = 1e6 * (animal.wingspan + animal.body_length);
  const Vec3d helper = std::abs(to_viewer.z) < 0.7 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  const Vec3d x = Normalized(Cross(to_viewer, helper)), y = Cross(to_viewer, x);
  std::vector<ConvexPolygon> polygons;
  for (const BodyPart& part : BodyParts(animal, 0, far * to_viewer)) {
    std::array<Vec2d, ConvexPolygon::kMaxCorners> points;
    for (std::size_t k = 0; k < static_cast<std::size_t>(part.corners); ++k) {
      points[k] = {Dot(part.corner[k], x), Dot(part.corner[k], y)};
    }
    polygons.push_back(HullOf({points.data(), static_cast<std::size_t>(part.corners)}));
  }
  return MomentsOf(UnionOf(polygons)).area;
}

// A place on one axis of the grid: between `low` and `high`, `share` of the way.
struct Place {
  std::size_t low, high;
  double share;
};

Place PlaceOn(double x, int last) {
  const double inside = std::clamp(x, 0.0, double(last));
  const int low = std::min(static_cast<int>(inside), last - 1);
  return {static_cast<std::size_t>(low), static_cast<std::size_t>(low) + 1, inside - low};
}

// |d pixel / d normalised| at `n`, by central differences.
double AreaScale(const Intrinsics& k, const Vec2d& n) {
  constexpr double kStep = 1e-5;
  const Vec2d right = ProjectNormalized(k, Vec2d{n.x + kStep, n.y});
  const Vec2d left = ProjectNormalized(k, Vec2d{n.x - kStep, n.y});
  const Vec2d below = ProjectNormalized(k, Vec2d{n.x, n.y + kStep});
  const Vec2d above = ProjectNormalized(k, Vec2d{n.x, n.y - kStep});
  return std::abs((right.x - left.x) * (below.y - above.y) -
                  (right.y - left.y) * (below.x - above.x)) /
         (4 * kStep * kStep);
}

}  // namespace

// Areas divided by wingspan^2 + body_length^2.
struct SpeckAreas::Table {
  std::vector<float> value;

  static std::size_t Index(std::size_t elevation, std::size_t azimuth, std::size_t phase) {
    return (elevation * (kAzimuths + 1) + azimuth) * kPhases + phase;
  }

  explicit Table(double ratio) {
    Animal animal{.id = 0, .wingspan = 1, .body_length = ratio, .wingbeat_hz = 1};
    for (int e = 0; e <= kElevations; ++e) {
      const double up = static_cast<double>(e * e) / (kElevations * kElevations);
      const double across = std::sqrt(std::max(0.0, 1 - up * up));
      for (int a = 0; a <= kAzimuths; ++a) {
        const double azimuth = kPi * a / kAzimuths;
        for (int p = 0; p < kPhases; ++p) {
          animal.wingbeat_phase = 2 * kPi * p / kPhases;
          value.push_back(static_cast<float>(
              ExactArea(animal, {across * std::cos(azimuth), across * std::sin(azimuth), up}) /
              (1 + ratio * ratio)));
        }
      }
    }
  }

  double At(const Place& elevation, const Place& azimuth, const Place& phase) const {
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const bool e = (corner & 1) != 0, a = (corner & 2) != 0, p = (corner & 4) != 0;
      const double weight = (e ? elevation.share : 1 - elevation.share) *
                            (a ? azimuth.share : 1 - azimuth.share) *
                            (p ? phase.share : 1 - phase.share);
      sum += weight * value[Index(e ? elevation.high : elevation.low,
                                  a ? azimuth.high : azimuth.low, p ? phase.high : phase.low)];
    }
    return sum;
  }
};

struct SpeckAreas::Slot {
  std::once_flag once;
  std::unique_ptr<Table> table;
};

SpeckAreas::SpeckAreas()
    : slots_(std::make_unique<std::vector<Slot>>(kHighestRatio - kLowestRatio + 1)) {}
SpeckAreas::~SpeckAreas() = default;

const SpeckAreas::Table& SpeckAreas::TableOf(int ratio) const {
  Slot& slot = (*slots_)[static_cast<std::size_t>(ratio - kLowestRatio)];
  std::call_once(slot.once,
                 [&] { slot.table = std::make_unique<Table>(std::pow(kRatioStep, ratio)); });
  return *slot.table;
}

double SpeckAreas::Area(const Animal& animal, double time, const Vec3d& to_viewer) const {
  const Vec3d d = to_viewer.z < 0 ? -to_viewer : to_viewer;
  const double azimuth = std::atan2(std::abs(d.y), d.x);
  // Wings level and stretched, as in a glide, is half a turn.
  const double turns =
      animal.wingbeat_hz > 0 ? animal.wingbeat_hz * time + animal.wingbeat_phase / (2 * kPi) : 0.5;
  const double phase = kPhases * (turns - std::floor(turns));
  const int before = static_cast<int>(phase) % kPhases;
  const Place at_elevation = PlaceOn(kElevations * std::sqrt(d.z), kElevations);
  const Place at_azimuth = PlaceOn(kAzimuths * azimuth / kPi, kAzimuths);
  const Place at_phase{static_cast<std::size_t>(before),
                       static_cast<std::size_t>((before + 1) % kPhases), phase - std::floor(phase)};
  const double exponent =
      std::clamp(std::log(animal.body_length / animal.wingspan) / std::log(kRatioStep),
                 double(kLowestRatio), double(kHighestRatio));
  const int lower = std::min(static_cast<int>(std::floor(exponent)), kHighestRatio - 1);
  const double share = exponent - lower;
  double area = (1 - share) * TableOf(lower).At(at_elevation, at_azimuth, at_phase);
  if (share > 0) area += share * TableOf(lower + 1).At(at_elevation, at_azimuth, at_phase);
  return area * (animal.wingspan * animal.wingspan + animal.body_length * animal.body_length);
}

double SizePx(const Animal& animal, double depth, const Camera& camera) {
  return std::max(animal.wingspan, animal.body_length) *
         std::max(camera.intrinsics.fx, camera.intrinsics.fy) / depth;
}

std::optional<Speck> ProjectSpeck(const FlyingAnimal& flying, double time, double shutter,
                                  const SpeckAreas& areas, const Camera& camera,
                                  const Rigid3d& cam_from_world) {
  const Vec3d in_cam = cam_from_world * flying.position;
  const Vec3d half_way = cam_from_world.rotation * (0.5 * shutter * flying.velocity);
  const Vec3d from = in_cam - half_way, to = in_cam + half_way;
  if (!(in_cam.z > 0 && from.z > 0 && to.z > 0)) return std::nullopt;
  const Intrinsics& k = camera.intrinsics;
  Speck speck{Project(k, from), Project(k, to), in_cam.z, 0};
  const double left = std::min(speck.from.x, speck.to.x),
               right = std::max(speck.from.x, speck.to.x);
  const double top = std::min(speck.from.y, speck.to.y);
  const double bottom = std::max(speck.from.y, speck.to.y);
  if (!(right > -1 && left < camera.width && bottom > -1 && top < camera.height)) {
    return std::nullopt;
  }
  const Vec2d n{in_cam.x / in_cam.z, in_cam.y / in_cam.z};
  double scale = k.fx * k.fy;
  if (std::any_of(k.distortion.begin(), k.distortion.end(), [](double d) { return d != 0; })) {
    const auto ray = RayThroughPixel(k, ProjectNormalized(k, n));
    if (!ray || std::hypot(ray->x - n.x, ray->y - n.y) > 1e-6) return std::nullopt;
    scale = AreaScale(k, n);
  }
  const double distance = Norm(in_cam);
  const Vec3d to_viewer = flying.world_from_body.Inverse() *
                          (cam_from_world.rotation.Inverse() * (in_cam * (-1 / distance)));
  speck.area = areas.Area(flying.animal, time, to_viewer) * scale * distance /
               (in_cam.z * in_cam.z * in_cam.z);
  return speck;
}

}  // namespace flocklift
