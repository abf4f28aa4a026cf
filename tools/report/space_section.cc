// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "simulate/camera/projection.h"
#include "tools/plot/markup.h"
#include "tools/plot/plot.h"
#include "tools/report/camera_depth.h"
#include "tools/report/sections.h"
#include "tools/report/view_basis.h"

namespace flocklift {
namespace {

constexpr std::size_t kMostPaths = 400;
constexpr std::size_t kMostErrorBars = 150;
constexpr int kBridged = 6;      // frames; a path goes on over shorter gaps
constexpr double kTrail = 1;     // of each animal of a large flock [s]
constexpr double kLongest = 20;  // a longer sequence shows this much of its paths [s]

struct Moment {
  int frame = 0;
  int first_path_frame = 0, last_path_frame = 0;
};

// The moment with the most animals, away from the ends of the sequence where it can be.
Moment ChooseMoment(const ReportData& data) {
  const FrameSpan span = SpanOf(*data.run.trajectories);
  Moment moment{(span.first + span.last) / 2, span.first, span.last};
  int most = 0;
  for (const FlockStatistics& statistics : data.flock) {
    const bool nearer_the_middle = std::abs(2 * statistics.frame - span.first - span.last) <
                                   std::abs(2 * moment.frame - span.first - span.last);
    if (statistics.count > most || (statistics.count == most && nearer_the_middle)) {
      most = statistics.count;
      moment.frame = statistics.frame;
    }
  }
  const double frames_a_second = data.run.fps.value_or(30);
  const int window = static_cast<int>(kLongest * frames_a_second);
  if (most > static_cast<int>(kMostErrorBars)) {  // a large flock: trails instead of paths
    moment.first_path_frame =
        std::max(span.first, moment.frame - static_cast<int>(kTrail * frames_a_second));
    moment.last_path_frame = moment.frame;
  } else if (span.last - span.first > window) {
    moment.first_path_frame = std::max(span.first, moment.frame - window / 2);
    moment.last_path_frame = std::min(span.last, moment.frame + window / 2);
  }
  return moment;
}

// Indices of the trajectories, those with most points first, at most kMostPaths.
std::vector<std::size_t> LongestPaths(const Trajectories& trajectories) {
  std::vector<std::size_t> order(trajectories.trajectories.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return trajectories.trajectories[a].points.size() > trajectories.trajectories[b].points.size();
  });
  order.resize(std::min(order.size(), kMostPaths));
  return order;
}

// The picture's edges as rays: for the top view the middles of its left and right edge, for the
// side view those of its upper and lower edge.
std::vector<Vec3d> EdgeRays(const Camera& camera, int frame, bool side_view) {
  std::vector<Vec3d> rays;
  if (camera.width <= 0 || camera.height <= 0) return rays;
  const double middle_u = 0.5 * (camera.width - 1), middle_v = 0.5 * (camera.height - 1);
  const std::vector<Vec2d> pixels =
      side_view ? std::vector<Vec2d>{{middle_u, -0.5}, {middle_u, camera.height - 0.5}}
                : std::vector<Vec2d>{{-0.5, middle_v}, {camera.width - 0.5, middle_v}};
  for (const Vec2d& pixel : pixels) {
    if (const auto ray = RayThroughPixel(camera.intrinsics, pixel)) {
      rays.push_back(camera.CamFromWorld(frame).Inverse().rotation * Vec3d{ray->x, ray->y, 1});
    }
  }
  return rays;
}

const TrajectoryPoint* PointAt(const Trajectory& trajectory, int frame) {
  const auto& points = trajectory.points;
  const auto point =
      std::lower_bound(points.begin(), points.end(), frame,
                       [](const TrajectoryPoint& p, int wanted) { return p.frame < wanted; });
  return point != points.end() && point->frame == frame ? &*point : nullptr;
}

// What the views can show without becoming unreadable.
struct ViewContents {
  bool camera = true;      // a flock far away would be a speck beside it
  bool error_bars = true;  // too many hide the animals
  double arrow = 13;       // size of an arrow head [px]
};

// One view, the camera on the left and looking right: (ahead, left) from above, (ahead, height)
// from the side.
class View {
 public:
  View(const ReportData& data, const Moment& moment, const ViewContents& with, bool from_the_side)
      : data_(data),
        moment_(moment),
        basis_(*data.run.camera, moment.frame),
        with_(with),
        side_(from_the_side) {}

  std::string Svg() const {
    Plot plot({.title = side_ ? "From the side" : "From above",
               .x_label = "ahead of the camera [m]",
               .y_label = !side_                   ? "left of the camera [m]"
                          : basis_.knows_gravity() ? "height [m]"
                                                   : "above the optical axis [m]",
               .height = 0,
               .equal_axes = true});
    AddCamera(&plot);
    AddErrorBars(&plot);
    AddPaths(&plot);
    AddArrows(&plot);
    return plot.Svg();
  }

 private:
  Vec2d Flat(const Vec3d& right_ahead_up) const {
    return side_ ? Vec2d{right_ahead_up.y, right_ahead_up.z}
                 : Vec2d{right_ahead_up.y, -right_ahead_up.x};
  }
  Vec2d Place(const Vec3d& point_in_world) const { return Flat(basis_.FromWorld(point_in_world)); }
  Vec2d Turn(const Vec3d& direction_in_world) const {
    return Flat(basis_.Turned(direction_in_world));
  }

  void AddCamera(Plot* plot) const {
    const Vec2d at = Flat(basis_.camera());
    for (const Vec3d& ray : EdgeRays(*data_.run.camera, moment_.frame, side_)) {
      const Vec2d along = Turn(ray);
      plot->AddLine({at, {at.x + 1e4 * along.x, at.y + 1e4 * along.y}},
                    {.color = "var(--muted)", .width = 1, .dash = "5 4", .sets_range = false});
    }
    if (!with_.camera) return;
    const Vec3d axis =
        data_.run.camera->CamFromWorld(moment_.frame).Inverse().rotation * Vec3d{0, 0, 1};
    plot->AddArrow(at, Turn(axis), {.color = "var(--ink)", .width = 18});
    plot->AddText(at, "camera", {});
  }

  // Along the ray through each animal, one standard deviation either way.
  void AddErrorBars(Plot* plot) const {
    if (!with_.error_bars) return;
    const Camera& camera = *data_.run.camera;
    std::vector<Vec2d> bars;
    for (const Trajectory& trajectory : data_.run.trajectories->trajectories) {
      const TrajectoryPoint* now = PointAt(trajectory, moment_.frame);
      if (now == nullptr || !(now->sd_depth > 0)) continue;
      const Rigid3d cam_from_world = camera.CamFromWorld(now->frame);
      const Vec3d in_cam = cam_from_world * now->position;
      if (!(in_cam.z > 0)) continue;
      for (const double sign : {-1.0, 1.0}) {
        const double factor = std::max(0.0, 1 + sign * now->sd_depth / in_cam.z);
        bars.push_back(Place(cam_from_world.Inverse() * (in_cam * factor)));
      }
      bars.push_back({std::nan(""), std::nan("")});
    }
    plot->AddLine(bars, {.color = "var(--muted)",
                         .width = 1,
                         .opacity = 0.6,
                         .label = "\xC2\xB1 1 sd of depth",
                         .sets_range = false});
  }

  void AddPaths(Plot* plot) const {
    const Trajectories& trajectories = *data_.run.trajectories;
    for (const std::size_t k : LongestPaths(trajectories)) {
      const Trajectory& trajectory = trajectories.trajectories[k];
      std::vector<Vec2d> path;
      int previous = 0;
      for (const TrajectoryPoint& point : trajectory.points) {
        if (point.frame < moment_.first_path_frame || point.frame > moment_.last_path_frame) {
          continue;
        }
        if (!path.empty() && point.frame > previous + kBridged) {
          path.push_back({std::nan(""), std::nan("")});
        }
        path.push_back(Place(point.position));
        previous = point.frame;
      }
      plot->AddLine(std::move(path), {.color = SeriesColor(static_cast<std::size_t>(trajectory.id)),
                                      .width = 1.2,
                                      .opacity = 0.55});
    }
  }

  void AddArrows(Plot* plot) const {
    for (const Trajectory& trajectory : data_.run.trajectories->trajectories) {
      const TrajectoryPoint* now = PointAt(trajectory, moment_.frame);
      if (now == nullptr) continue;
      plot->AddArrow(
          Place(now->position), Turn(now->velocity),
          {.color = SeriesColor(static_cast<std::size_t>(trajectory.id)), .width = with_.arrow});
    }
  }

  const ReportData& data_;
  Moment moment_;
  ViewBasis basis_;
  ViewContents with_;
  bool side_;
};

bool CameraFits(const ReportData& data, const Moment& moment) {
  const ViewBasis basis(*data.run.camera, moment.frame);
  double near = 1e300, far = -1e300, left = 1e300, right = -1e300;
  for (const Trajectory& trajectory : data.run.trajectories->trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) {
      if (point.frame < moment.first_path_frame || point.frame > moment.last_path_frame) continue;
      const Vec3d p = basis.FromWorld(point.position);
      near = std::min(near, p.y);
      far = std::max(far, p.y);
      left = std::min(left, p.x);
      right = std::max(right, p.x);
    }
  }
  return far < 4 * std::max(far - near, right - left);
}

ViewContents ContentsFor(const ReportData& data, const Moment& moment) {
  std::size_t animals = 0, with_sd = 0;
  for (const Trajectory& trajectory : data.run.trajectories->trajectories) {
    const TrajectoryPoint* now = PointAt(trajectory, moment.frame);
    if (now == nullptr) continue;
    ++animals;
    if (now->sd_depth > 0) ++with_sd;
  }
  return {.camera = CameraFits(data, moment),
          .error_bars = with_sd > 0 && with_sd <= kMostErrorBars,
          .arrow = animals > kMostErrorBars ? 8.0 : 13.0};
}

}  // namespace

void AddSpaceSection(const ReportData& data, Page* page, Missing* missing) {
  const RunFolder& run = data.run;
  if (!run.trajectories || run.trajectories->trajectories.empty()) {
    missing->push_back("The flock in space: the folder has no trajectories.csv.");
    return;
  }
  if (!run.camera) {
    missing->push_back("The flock in space: no camera file was found for the folder.");
    return;
  }
  const Moment moment = ChooseMoment(data);
  page->BeginSection("space", "The flock in space");
  const std::size_t paths = run.trajectories->trajectories.size();
  std::string caption = fmt::format(
      "Arrow heads: where each animal is, and where it flies, in frame {}", moment.frame);
  if (run.fps) caption += fmt::format(" ({} s)", FixedText(run.TimeOf(moment.frame), 1));
  caption += run.trajectories->has_velocity ? ". " : " (velocities are not known without fps). ";
  const FrameSpan span = SpanOf(*run.trajectories);
  caption += moment.first_path_frame == span.first && moment.last_path_frame == span.last
                 ? "Lines: their paths over the whole sequence"
                 : fmt::format("Lines: their paths in frames {} to {}", moment.first_path_frame,
                               moment.last_path_frame);
  if (paths > kMostPaths) caption += fmt::format(" (the {} longest of {})", kMostPaths, paths);
  caption += ", coloured by identity (colours repeat). ";
  const ViewContents contents = ContentsFor(data, moment);
  if (contents.error_bars) {
    caption += "Grey bars: one standard deviation of depth along the viewing ray. ";
  }
  caption += "Dashed: the edges of the picture. ";
  if (!contents.camera) caption += "The camera stands far to the left, outside. ";
  caption += "A metre is equally long in both directions.";
  page->AddFigure(View(data, moment, contents, false).Svg(), caption);
  page->AddFigure(View(data, moment, contents, true).Svg(),
                  run.camera->KnowsGravity()
                      ? "The same from the side: height over the distance ahead of the camera."
                      : "The same from the side. The camera file has no pose, so up is the "
                        "picture's up, not gravity's.");
}

}  // namespace flocklift
