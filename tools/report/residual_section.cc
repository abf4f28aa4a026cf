// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "reconstruct/metrics/order_statistics.h"
#include "simulate/camera/projection.h"
#include "tools/plot/histogram.h"
#include "tools/plot/markup.h"
#include "tools/plot/plot.h"
#include "tools/plot/ticks.h"
#include "tools/report/sections.h"

namespace flocklift {
namespace {

struct Residuals {
  std::vector<double> u, v, distance;  // projected minus seen [px]
  std::size_t rows = 0;                // measured rows of the tracks
};

// Measured rows against the reconstructed points of the same id and frame, seen by the camera.
Residuals ComputeResiduals(const RunFolder& run) {
  std::unordered_map<Id, const Trajectory*> by_id;
  for (const Trajectory& trajectory : run.trajectories->trajectories) {
    by_id[trajectory.id] = &trajectory;
  }
  Residuals residuals;
  for (const Tracklet& tracklet : run.tracks->tracklets) {
    const auto found = by_id.find(tracklet.id);
    const std::vector<TrajectoryPoint> none;
    const auto& points = found == by_id.end() ? none : found->second->points;
    auto point = points.begin();
    for (const Detection& detection : tracklet.detections) {
      if (detection.confidence < kMeasuredConfidence) continue;
      ++residuals.rows;
      while (point != points.end() && point->frame < detection.frame) ++point;
      if (point == points.end() || point->frame != detection.frame) continue;
      const Vec3d in_cam = run.camera->CamFromWorld(point->frame) * point->position;
      if (!(in_cam.z > 0)) continue;
      const Vec2d projected = Project(run.camera->intrinsics, in_cam);
      const Vec2d seen = detection.box.Center();
      residuals.u.push_back(projected.x - seen.x);
      residuals.v.push_back(projected.y - seen.y);
      residuals.distance.push_back(std::hypot(projected.x - seen.x, projected.y - seen.y));
    }
  }
  return residuals;
}

}  // namespace

void AddResidualSection(const ReportData& data, Page* page, Missing* missing) {
  const RunFolder& run = data.run;
  if (!run.trajectories || !run.tracks || !run.camera) {
    missing->push_back(
        "Reprojection residuals: they need tracks.csv, trajectories.csv and a camera file.");
    return;
  }
  Residuals residuals = ComputeResiduals(run);
  if (residuals.distance.empty()) {
    missing->push_back(
        "Reprojection residuals: no row of tracks.csv has a point of its id in trajectories.csv.");
    return;
  }
  page->BeginSection("residuals", "Residuals in the image");
  const double covered =
      100.0 * static_cast<double>(residuals.distance.size()) / static_cast<double>(residuals.rows);
  std::vector<double> sorted = residuals.distance;
  std::sort(sorted.begin(), sorted.end());
  const double median = QuantileOfSorted(sorted, 0.5), p95 = QuantileOfSorted(sorted, 0.95);
  const double high = std::max(QuantileOfSorted(sorted, 0.99), 1e-3);

  page->BeginGrid(2);
  const AxisRange range = NiceRange(0, high, 10);
  Plot distances({.title = "Reprojection error",
                  .x_label = "distance in the image [px]",
                  .y_label = "share of points [%]",
                  .width = 520,
                  .height = 270,
                  .x_low = 0,
                  .x_high = range.high});
  distances.AddBars(MakeHistogram(residuals.distance, 0, range.high, 40), {.opacity = 0.75});
  distances.AddVerticalLine(
      median, {.color = "var(--ink)", .width = 1.4, .dash = "5 3", .label = "median"});
  page->AddFigure(
      distances.Svg(),
      fmt::format(
          "How far each reconstructed point, seen by the camera, lies from where the animal "
          "was measured: median {} px, 95 % below {} px. {} % of the measured rows have a "
          "point.",
          NumberText(median), NumberText(p95), NumberText(covered)));

  const double bound = NiceRange(0, *Quantile(residuals.distance, 0.98) + 1e-6, 6).high;
  Plot parts({.title = "To the right and downwards",
              .x_label = "projected minus measured [px]",
              .y_label = "share of points [%]",
              .width = 520,
              .height = 270,
              .x_low = -bound,
              .x_high = bound});
  parts.AddBars(MakeHistogram(residuals.u, -bound, bound, 41), {.opacity = 0.45, .label = "u"});
  parts.AddOutline(MakeHistogram(residuals.v, -bound, bound, 41),
                   {.color = "var(--c1)", .width = 1.6, .label = "v"});
  page->AddFigure(
      parts.Svg(),
      fmt::format("The same by direction. Medians {} px to the right and {} px downwards: away "
                  "from 0, the paths are pulled off the measurements.",
                  FixedText(*Median(residuals.u), 2), FixedText(*Median(residuals.v), 2)));
  page->EndGrid();
}

}  // namespace flocklift
