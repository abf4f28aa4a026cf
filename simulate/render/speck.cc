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

// What a table holds of a direction: area, moments, and SpeckAreas::Shadow::reach.
constexpr std::size_t kReaches = SpeckAreas::Shadow::kDirections;
constexpr std::size_t kValues = 4 + kReaches;
using Values = std::array<double, kValues>;

// The plane across a line of sight: x is horizontal in the body frame.
Vec3d AcrossX(double azimuth) { return {-std::sin(azimuth), std::cos(azimuth), 0}; }

Values Measure(const Animal& animal, double azimuth, double up) {
  const double across = std::sqrt(std::max(0.0, 1 - up * up));
  const Vec3d to_viewer{across * std::cos(azimuth), across * std::sin(azimuth), up};
  const double far = 1e6 * (animal.wingspan + animal.body_length);
  const Vec3d x = AcrossX(azimuth), y = Cross(to_viewer, x);
  std::vector<ConvexPolygon> polygons;
  for (const BodyPart& part : BodyParts(animal, 0, far * to_viewer)) {
    std::array<Vec2d, ConvexPolygon::kMaxCorners> points;
    for (std::size_t k = 0; k < static_cast<std::size_t>(part.corners); ++k) {
      points[k] = {Dot(part.corner[k], x), Dot(part.corner[k], y)};
    }
    polygons.push_back(HullOf({points.data(), static_cast<std::size_t>(part.corners)}));
  }
  const SilhouetteMoments m = MomentsOf(UnionOf(polygons));
  Values values{m.area, m.xx, m.xy, m.yy};
  for (std::size_t k = 0; k < kReaches; ++k) {
    const double angle = kPi * static_cast<double>(k) / kReaches;
    const double c = std::cos(angle), s = std::sin(angle);
    double least = 0, most = 0;  // of the centroid's place along the direction
    for (const ConvexPolygon& polygon : polygons) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.corners); ++i) {
        const Vec2d& p = polygon.corner[i];
        const double along = c * (p.x - m.centroid.x) + s * (p.y - m.centroid.y);
        least = std::min(least, along);
        most = std::max(most, along);
      }
    }
    values[4 + k] = 0.5 * (most - least);
  }
  return values;
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

// d pixel / d normalised.
struct LensSlopes {
  double uu, uv, vu, vv;

  double Determinant() const { return uu * vv - uv * vu; }
};

// By central differences, at `n`.
LensSlopes SlopesAt(const Intrinsics& k, const Vec2d& n) {
  constexpr double kStep = 1e-5;
  const Vec2d right = ProjectNormalized(k, Vec2d{n.x + kStep, n.y});
  const Vec2d left = ProjectNormalized(k, Vec2d{n.x - kStep, n.y});
  const Vec2d below = ProjectNormalized(k, Vec2d{n.x, n.y + kStep});
  const Vec2d above = ProjectNormalized(k, Vec2d{n.x, n.y - kStep});
  return {(right.x - left.x) / (2 * kStep), (below.x - above.x) / (2 * kStep),
          (right.y - left.y) / (2 * kStep), (below.y - above.y) / (2 * kStep)};
}

// Nothing where the distortion has folded the plane.
std::optional<LensSlopes> LensAt(const Intrinsics& k, const Vec2d& n) {
  if (std::all_of(k.distortion.begin(), k.distortion.end(), [](double d) { return d == 0; })) {
    return LensSlopes{k.fx, 0, 0, k.fy};
  }
  const auto ray = RayThroughPixel(k, ProjectNormalized(k, n));
  if (!ray || std::hypot(ray->x - n.x, ray->y - n.y) > 1e-6) return std::nullopt;
  return SlopesAt(k, n);
}

// From the animal to the camera, body frame, unit.
Vec3d ToViewer(const FlyingAnimal& flying, const Vec3d& in_cam, const Rigid3d& cam_from_world) {
  return flying.world_from_body.Inverse() *
         (cam_from_world.rotation.Inverse() * (in_cam * (-1 / Norm(in_cam))));
}

}  // namespace

// A place in the tables. The viewer is brought to y >= 0 and z >= 0.
struct SpeckAreas::Spot {
  Place elevation, azimuth, phase;
  int lower;     // ratio
  double share;  // of the next one
  double up, azimuth_rad;
  bool is_mirrored;  // y is turned round
};

// Lengths divided by sqrt(wingspan^2 + body_length^2).
struct SpeckAreas::Table {
  std::vector<std::array<float, kValues>> value;

  static std::size_t Index(std::size_t elevation, std::size_t azimuth, std::size_t phase) {
    return (elevation * (kAzimuths + 1) + azimuth) * kPhases + phase;
  }

  explicit Table(double ratio) {
    Animal animal{.id = 0, .wingspan = 1, .body_length = ratio, .wingbeat_hz = 1};
    const double unit = std::sqrt(1 + ratio * ratio);
    for (int e = 0; e <= kElevations; ++e) {
      const double up = static_cast<double>(e * e) / (kElevations * kElevations);
      for (int a = 0; a <= kAzimuths; ++a) {
        for (int p = 0; p < kPhases; ++p) {
          animal.wingbeat_phase = 2 * kPi * p / kPhases;
          const Values values = Measure(animal, kPi * a / kAzimuths, up);
          auto& kept = value.emplace_back();
          for (std::size_t k = 0; k < kValues; ++k) {
            kept[k] = static_cast<float>(values[k] / (k < 4 ? unit * unit : unit));
          }
        }
      }
    }
  }

  // Adds `weight` times the first `Count` values there.
  template <std::size_t Count>
  void AddAt(const Spot& spot, double weight, Values* sum) const {
    for (int corner = 0; corner < 8; ++corner) {
      const bool e = (corner & 1) != 0, a = (corner & 2) != 0, p = (corner & 4) != 0;
      const double share = weight * (e ? spot.elevation.share : 1 - spot.elevation.share) *
                           (a ? spot.azimuth.share : 1 - spot.azimuth.share) *
                           (p ? spot.phase.share : 1 - spot.phase.share);
      const auto& here = value[Index(e ? spot.elevation.high : spot.elevation.low,
                                     a ? spot.azimuth.high : spot.azimuth.low,
                                     p ? spot.phase.high : spot.phase.low)];
      for (std::size_t k = 0; k < Count; ++k) (*sum)[k] += share * here[k];
    }
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

SpeckAreas::Spot SpeckAreas::Find(const Animal& animal, double time, const Vec3d& to_viewer) {
  const Vec3d d = to_viewer.z < 0 ? -to_viewer : to_viewer;
  const double azimuth = std::atan2(std::abs(d.y), d.x);
  // Wings level and stretched, as in a glide, is half a turn.
  const double turns =
      animal.wingbeat_hz > 0 ? animal.wingbeat_hz * time + animal.wingbeat_phase / (2 * kPi) : 0.5;
  const double phase = kPhases * (turns - std::floor(turns));
  const int before = static_cast<int>(phase) % kPhases;
  const double exponent =
      std::clamp(std::log(animal.body_length / animal.wingspan) / std::log(kRatioStep),
                 double(kLowestRatio), double(kHighestRatio));
  const int lower = std::min(static_cast<int>(std::floor(exponent)), kHighestRatio - 1);
  return {.elevation = PlaceOn(kElevations * std::sqrt(d.z), kElevations),
          .azimuth = PlaceOn(kAzimuths * azimuth / kPi, kAzimuths),
          .phase = {static_cast<std::size_t>(before),
                    static_cast<std::size_t>((before + 1) % kPhases), phase - std::floor(phase)},
          .lower = lower,
          .share = exponent - lower,
          .up = d.z,
          .azimuth_rad = azimuth,
          .is_mirrored = d.y < 0};
}

double SpeckAreas::Area(const Animal& animal, double time, const Vec3d& to_viewer) const {
  const Spot spot = Find(animal, time, to_viewer);
  Values values{};
  TableOf(spot.lower).AddAt<1>(spot, 1 - spot.share, &values);
  if (spot.share > 0) TableOf(spot.lower + 1).AddAt<1>(spot, spot.share, &values);
  return values[0] * (animal.wingspan * animal.wingspan + animal.body_length * animal.body_length);
}

SpeckAreas::Shadow SpeckAreas::Look(const Animal& animal, double time,
                                    const Vec3d& to_viewer) const {
  const Spot spot = Find(animal, time, to_viewer);
  Values values{};
  TableOf(spot.lower).AddAt<kValues>(spot, 1 - spot.share, &values);
  if (spot.share > 0) TableOf(spot.lower + 1).AddAt<kValues>(spot, spot.share, &values);
  const double unit = std::hypot(animal.wingspan, animal.body_length), square = unit * unit;
  const double across = std::sqrt(std::max(0.0, 1 - spot.up * spot.up));
  Shadow shadow{
      .x = AcrossX(spot.azimuth_rad),
      .y = {-spot.up * std::cos(spot.azimuth_rad), -spot.up * std::sin(spot.azimuth_rad), across},
      .area = square * values[0],
      .xx = square * values[1],
      .xy = square * values[2],
      .yy = square * values[3],
      .reach = {}};
  for (std::size_t k = 0; k < kReaches; ++k) shadow.reach[k] = unit * values[4 + k];
  if (spot.is_mirrored) {
    shadow.x.y = -shadow.x.y;
    shadow.y.y = -shadow.y.y;
  }
  return shadow;
}

double SpeckAreas::Shadow::Reach(const Vec2d& direction) const {
  double place = kDirections * std::atan2(direction.y, direction.x) / kPi;
  if (place < 0) place += kDirections;  // both ways are the same
  const auto k = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(k);
  return std::hypot(direction.x, direction.y) *
         ((1 - share) * reach[k % kDirections] + share * reach[(k + 1) % kDirections]);
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
  const auto lens = LensAt(k, n);
  if (!lens) return std::nullopt;
  const Vec3d to_viewer = ToViewer(flying, in_cam, cam_from_world);
  speck.area = areas.Area(flying.animal, time, to_viewer) * std::abs(lens->Determinant()) *
               Norm(in_cam) / (in_cam.z * in_cam.z * in_cam.z);
  return speck;
}

std::optional<SpeckBox> ProjectSpeckBox(const FlyingAnimal& flying, double time,
                                        const SpeckAreas& areas, const Camera& camera,
                                        const Rigid3d& cam_from_world) {
  const Vec3d in_cam = cam_from_world * flying.position;
  if (!(in_cam.z > 0)) return std::nullopt;
  const Vec2d n{in_cam.x / in_cam.z, in_cam.y / in_cam.z};
  const auto lens = LensAt(camera.intrinsics, n);
  if (!lens) return std::nullopt;
  const SpeckAreas::Shadow shadow =
      areas.Look(flying.animal, time, ToViewer(flying, in_cam, cam_from_world));
  // L: what a metre along x or y of the shadow is in the image [px].
  const auto in_image = [&](const Vec3d& axis_in_body) {
    const Vec3d d = cam_from_world.rotation * (flying.world_from_body * axis_in_body);
    const Vec2d m{(d.x - n.x * d.z) / in_cam.z, (d.y - n.y * d.z) / in_cam.z};
    return Vec2d{lens->uu * m.x + lens->uv * m.y, lens->vu * m.x + lens->vv * m.y};
  };
  const Vec2d x = in_image(shadow.x), y = in_image(shadow.y);
  const auto covariance = [&](double xa, double ya, double xb, double yb) {
    return xa * xb * shadow.xx + (xa * yb + ya * xb) * shadow.xy + ya * yb * shadow.yy;
  };
  return SpeckBox{.half_width = shadow.Reach({x.x, y.x}),
                  .half_height = shadow.Reach({x.y, y.y}),
                  .moments = {.area = shadow.area * std::abs(x.x * y.y - x.y * y.x),
                              .centroid = ProjectNormalized(camera.intrinsics, n),
                              .xx = covariance(x.x, y.x, x.x, y.x),
                              .xy = covariance(x.x, y.x, x.y, y.y),
                              .yy = covariance(x.y, y.y, x.y, y.y)},
                  .depth = in_cam.z};
}

}  // namespace flocklift
