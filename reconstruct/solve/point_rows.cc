// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/point_rows.h"

#include <ceres/jet.h>

#include <array>
#include <cmath>

#include "reconstruct/cost_functions/reprojection.h"

namespace flocklift::internal {
namespace {

using Jet12 = ceres::Jet<double, 12>;  // by the four control points around a time

// z n at a place of the path.
Vec3<Jet12> PositionAt(const Bird& bird, const Bird::Place& place) {
  std::array<Jet12, 3> q;
  for (int a = 0; a < 12; ++a) {
    q[a % 3] += place.weights[a / 3] *
                Jet12(bird.path[3 * static_cast<std::size_t>(place.interval) + a], a);
  }
  const Jet12 z = exp(q[2]);
  return {z * q[0], z * q[1], z};
}

Vec3<Jet12> Transformed(const Rigid3d& transform, const Vec3<Jet12>& p) {
  const auto& m = transform.rotation.m;
  const Vec3d& t = transform.translation;
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + t.x, m[3] * p.x + m[4] * p.y + m[5] * p.z + t.y,
          m[6] * p.x + m[7] * p.y + m[8] * p.z + t.z};
}

ResidualRow RowOf(const Bird::Place& place, const Jet12& error, double sd) {
  ResidualRow row;
  row.first = 3 * place.interval;
  row.residual = error.a / sd;
  for (int a = 0; a < 12; ++a) row.path[a] = error.v[a] / sd;
  return row;
}

}  // namespace

void TakeReprojections(const Bird& bird, bool derivatives, const RowSink& take) {
  std::array<ResidualRow, 2> rows;
  for (std::size_t k = 0; k < bird.places.size(); ++k) {
    const Bird::Place& place = bird.places[k];
    const Sighting& sighting = bird.segment->sightings[k];
    const ReprojectionError error{place.weights, sighting.ray, sighting.ray_sd};
    std::array<double, 2> residuals;
    error(&bird.path[3 * static_cast<std::size_t>(place.interval)], residuals.data());
    for (int axis = 0; axis < 2; ++axis) {
      ResidualRow& row = rows[axis];
      row.first = 3 * place.interval;
      row.residual = residuals[axis];
      for (int a = 0; a < 4 && derivatives; ++a) {
        row.path[3 * a + axis] = place.weights[a] / sighting.ray_sd;
      }
      take(Term::kReprojection, row);
    }
  }
}

void TakeViews(const Bird& bird, const RowSink& take) {
  constexpr double kNearest = 0.01;  // in front of the second camera [m]
  for (std::size_t k = 0; k < bird.view_places.size(); ++k) {
    const View& view = bird.segment->views[k];
    const Vec3<Jet12> q = Transformed(view.view_from_ref, PositionAt(bird, bird.view_places[k]));
    if (q.z.a < kNearest) continue;
    const std::array<Jet12, 2> error = {q.x / q.z - view.ray.x, q.y / q.z - view.ray.y};
    for (const Jet12& e : error) take(Term::kView, RowOf(bird.view_places[k], e, view.ray_sd));
  }
}

void TakeAnchors(const Bird& bird, const RowSink& take) {
  for (const Bird::Known& known : bird.anchors) {
    const Vec3<Jet12> p = PositionAt(bird, known.place);
    const std::array<Jet12, 3> error = {p.x - known.position_in_cam.x,
                                        p.y - known.position_in_cam.y,
                                        p.z - known.position_in_cam.z};
    for (const Jet12& e : error) take(Term::kAnchor, RowOf(known.place, e, known.sd));
  }
}

void TakeBounds(const BatchModel& model, const Bird& bird, const RowSink& take) {
  constexpr double kSoftness = 0.02;  // in log depth
  if (!model.log_near && !model.log_far) return;
  for (int knot = 0; knot < bird.knots; ++knot) {
    const double* c = &bird.path[3 * static_cast<std::size_t>(knot)];
    const double l = (c[2] + 4 * c[5] + c[8]) / 6;
    double beyond = 0;
    if (model.log_near && l < *model.log_near) beyond = l - *model.log_near;
    if (model.log_far && l > *model.log_far) beyond = l - *model.log_far;
    if (beyond == 0) continue;
    ResidualRow row;
    row.first = 3 * knot;
    row.residual = beyond / kSoftness;
    row.path[2] = row.path[8] = 1 / (6 * kSoftness);
    row.path[5] = 4 / (6 * kSoftness);
    take(Term::kBounds, row);
  }
}

void TakeAnyVelocity(const BatchModel& model, const Bird& bird, const RowSink& take) {
  const double sd = 60 * bird.softening;  // the softening is a twentieth of the speed
  const double scale = 0.5 / (model.knot_interval * sd);
  for (int axis = 0; axis < 3; ++axis) {
    ResidualRow row;
    row.residual = scale * (bird.path[6 + axis] - bird.path[axis]);
    row.path[axis] = -scale;
    row.path[6 + axis] = scale;
    take(Term::kAnyVelocity, row);
  }
}

}  // namespace flocklift::internal
