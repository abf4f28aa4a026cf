// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The programme is solved by taking half-spaces in turn (de Berg et al., "Computational Geometry",
// chapter 4): an optimum that the next one excludes moves into its plane, where the same problem
// has one dimension less.

#include "simulate/flock/orca.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace flocklift {
namespace {

constexpr double kTiny = 1e-10;            // of lengths of 1: parallel, or no direction
constexpr double kSlack = 1e-9;            // [m/s] by which a half-space counts as satisfied
constexpr std::int64_t kOrcaRowGrain = 4;  // rows of cells a chunk of work

// What is wanted: the point nearest to `target`, or the one farthest along it.
struct Wish {
  Vec3d target;
  bool direction;
};

double Violation(const HalfSpace& h, const Vec3d& v) { return Dot(h.normal, h.point - v); }

// A unit vector across `unit`; that of -unit is its negative, so that two animals that fly straight
// at each other part to opposite sides.
Vec3d Across(const Vec3d& unit) {
  const double x = std::abs(unit.x), y = std::abs(unit.y), z = std::abs(unit.z);
  const Vec3d axis = x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  return Normalized(Cross(unit, axis));
}

struct Line {
  Vec3d point, direction;
};

std::optional<Vec3d> BestOnLine(std::span<const HalfSpace> allowed, const Line& line,
                                double max_speed, const Wish& wish) {
  const double middle = -Dot(line.point, line.direction);
  const double squared = middle * middle + max_speed * max_speed - SquaredNorm(line.point);
  if (squared < 0) return std::nullopt;
  const double half = std::sqrt(squared);
  double low = middle - half, high = middle + half;
  for (const HalfSpace& h : allowed) {
    const double slope = Dot(line.direction, h.normal), lack = Violation(h, line.point);
    if (std::abs(slope) <= kTiny) {
      if (lack > kSlack) return std::nullopt;
      continue;
    }
    double& end = slope > 0 ? low : high;
    end = slope > 0 ? std::max(low, lack / slope) : std::min(high, lack / slope);
    if (low > high) return std::nullopt;
  }
  const double along = wish.direction ? (Dot(wish.target, line.direction) > 0 ? high : low)
                                      : Dot(wish.target - line.point, line.direction);
  return line.point + std::clamp(along, low, high) * line.direction;
}

// In the plane that bounds the last of `allowed`.
std::optional<Vec3d> BestOnPlane(std::span<const HalfSpace> allowed, double max_speed,
                                 const Wish& wish) {
  const HalfSpace& plane = allowed.back();
  const double height = Dot(plane.point, plane.normal);
  if (std::abs(height) > max_speed) return std::nullopt;
  const Vec3d centre = height * plane.normal;  // of the disc of speeds that are allowed
  const double radius = std::sqrt(max_speed * max_speed - height * height);
  const Vec3d inside = wish.target - Dot(wish.target, plane.normal) * plane.normal;
  const double length = Norm(inside);
  Vec3d best = centre;
  if (length > kTiny) {
    best += (wish.direction ? radius / length : std::min(1.0, radius / length)) * inside;
  }
  for (std::size_t k = 0; k + 1 < allowed.size(); ++k) {
    if (Violation(allowed[k], best) <= kSlack) continue;
    const Vec3d cross = Cross(allowed[k].normal, plane.normal);
    if (SquaredNorm(cross) <= kTiny) return std::nullopt;
    const Vec3d direction = Normalized(cross);
    const Vec3d down = Cross(direction, plane.normal);  // in the plane, across the line
    const double way = Violation(allowed[k], plane.point) / Dot(down, allowed[k].normal);
    const auto on_line =
        BestOnLine(allowed.first(k), {plane.point + way * down, direction}, max_speed, wish);
    if (!on_line) return std::nullopt;
    best = *on_line;
  }
  return best;
}

// Takes the half-spaces in turn as long as there is a solution; returns how many it satisfies.
std::size_t BestInSpace(std::span<const HalfSpace> allowed, double max_speed, const Wish& wish,
                        Vec3d* best) {
  const double length = Norm(wish.target);
  *best = wish.direction || length > max_speed ? max_speed * Normalized(wish.target) : wish.target;
  for (std::size_t k = 0; k < allowed.size(); ++k) {
    if (Violation(allowed[k], *best) <= kSlack) continue;
    const auto on_plane = BestOnPlane(allowed.first(k + 1), max_speed, wish);
    if (!on_plane) return k;
    *best = *on_plane;
  }
  return allowed.size();
}

// From the first half-space on that cannot be had, the least greatest violation: at the new optimum
// the new one is violated most, so go as far along its normal as no other becomes the worst.
void LeastViolation(std::span<const HalfSpace> allowed, std::size_t first, double max_speed,
                    std::vector<HalfSpace>* room, Vec3d* best) {
  double worst = 0;
  for (std::size_t k = first; k < allowed.size(); ++k) {
    const HalfSpace& worse = allowed[k];
    if (Violation(worse, *best) <= worst + kSlack) continue;
    room->clear();
    for (const HalfSpace& other : allowed.first(k)) {  // those where `other` is violated less
      const Vec3d normal = other.normal - worse.normal;
      const double length = Norm(normal);
      if (length <= kTiny) continue;
      const double height = Dot(other.normal, other.point) - Dot(worse.normal, worse.point);
      room->push_back({(height / (length * length)) * normal, normal / length});
    }
    Vec3d candidate;
    if (BestInSpace(*room, max_speed, {worse.normal, true}, &candidate) == room->size()) {
      *best = candidate;  // it exists but for rounding
    }
    worst = std::max(0.0, Violation(worse, *best));
  }
}

}  // namespace

HalfSpace AvoidPair(const Vec3d& dx, const Vec3d& v_a, const Vec3d& v_b, double radii,
                    double horizon, double dt) {
  const double distance = Norm(dx);
  const Vec3d towards = distance > 0 ? dx / distance : Vec3d{1, 0, 0};
  const Vec3d v = v_a - v_b;
  const bool apart = distance > radii;
  const double time = apart ? horizon : dt;
  const Vec3d from_tip = v - dx / time;  // from the centre of the round tip
  const double tip = Norm(from_tip), sine = apart ? radii / distance : 1;
  HalfSpace h;
  double outside;  // distance of v from the surface; negative within
  if (!apart || Dot(from_tip, towards) < -sine * tip) {
    h.normal = tip > kTiny ? from_tip / tip : -towards;
    outside = tip - radii / time;
  } else {  // in the plane of dx and v the side of the cone is a line through 0
    const double along = Dot(v, towards);
    const Vec3d aside = v - along * towards;
    const double across = Norm(aside), cosine = std::sqrt(1 - sine * sine);
    const Vec3d away = across > kTiny * (1 + along) ? aside / across : Across(towards);
    h.normal = cosine * away - sine * towards;
    outside = cosine * across - sine * along;
  }
  h.point = v_a - (0.5 * outside) * h.normal;
  return h;
}

HalfSpace AvoidWall(const Vec3d& way_out, double distance, double radius, double horizon) {
  return {((radius - distance) / horizon) * way_out, way_out};
}

Vec3d NearestVelocity(std::span<const HalfSpace> allowed, const Vec3d& preferred, double max_speed,
                      std::vector<HalfSpace>* room) {
  Vec3d best;
  const std::size_t satisfied = BestInSpace(allowed, max_speed, {preferred, false}, &best);
  if (satisfied < allowed.size()) LeastViolation(allowed, satisfied, max_speed, room, &best);
  return best;
}

template <typename T>
void AvoidCollisions(const OrcaOptions& options, double dt, const CellGrid<T>& grid,
                     const Bodies<T>& bodies, const std::vector<T>& radius,
                     const AddWalls& add_walls, ThreadPool* pool,
                     std::vector<Vec3<T>>* velocities) {
  struct Other {
    double squared_distance;
    std::uint32_t number;
    bool operator<(const Other& b) const {
      return squared_distance != b.squared_distance ? squared_distance < b.squared_distance
                                                    : number < b.number;
    }
  };
  const auto to_double = [](const Vec3<T>& v) {
    return Vec3d{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  };
  const auto g = grid.view();
  const auto avoid = [&](std::uint32_t k, std::vector<Other>* others,
                         std::vector<HalfSpace>* allowed, std::vector<HalfSpace>* room) {
    const auto most = static_cast<std::size_t>(options.most_neighbours);
    if (others->size() > most) {
      std::nth_element(others->begin(), others->begin() + options.most_neighbours, others->end());
      others->resize(most);
    }
    std::sort(others->begin(), others->end());
    const Vec3d x = to_double(bodies.Position(k)), v = to_double(bodies.Velocity(k));
    allowed->clear();
    if (add_walls) add_walls(k, allowed);
    for (const Other& other : *others) {
      const std::uint32_t j = other.number;
      const double radii = static_cast<double>(radius[bodies.agent[k]]) +
                           static_cast<double>(radius[bodies.agent[j]]);
      allowed->push_back(AvoidPair(to_double(bodies.Position(j)) - x, v,
                                   to_double(bodies.Velocity(j)), radii, options.horizon, dt));
    }
    Vec3<T>& velocity = (*velocities)[k];
    const Vec3d best = NearestVelocity(*allowed, to_double(velocity), options.max_speed, room);
    velocity = {static_cast<T>(best.x), static_cast<T>(best.y), static_cast<T>(best.z)};
  };
  pool->For(0, g.RowCount(), kOrcaRowGrain, [&](std::int64_t first_row, std::int64_t last_row) {
    std::vector<Other> others;
    std::vector<HalfSpace> allowed, room;
    for (auto row = static_cast<int>(first_row); row < last_row; ++row) {
      const int b = 1 + row % g.ny, c = 1 + row / g.ny;
      for (std::uint32_t k = g.start[g.Cell(1, b, c)]; k < g.start[g.Cell(g.nx, b, c) + 1]; ++k) {
        const int a = g.CellX(bodies.x[k]);
        const Vec3d x = to_double(bodies.Position(k));
        others.clear();
        CellGrid<T>::ForEachRun(g, a, a, b, c, [&](std::uint32_t first, std::uint32_t last) {
          for (std::uint32_t j = first; j < last; ++j) {
            const double squared = SquaredNorm(to_double(bodies.Position(j)) - x);
            if (j != k && squared < options.sight * options.sight) others.push_back({squared, j});
          }
        });
        avoid(k, &others, &allowed, &room);
      }
    }
  });
}

template void AvoidCollisions(const OrcaOptions&, double, const CellGrid<float>&,
                              const Bodies<float>&, const std::vector<float>&, const AddWalls&,
                              ThreadPool*, std::vector<Vec3<float>>*);
template void AvoidCollisions(const OrcaOptions&, double, const CellGrid<double>&,
                              const Bodies<double>&, const std::vector<double>&, const AddWalls&,
                              ThreadPool*, std::vector<Vec3<double>>*);

}  // namespace flocklift
