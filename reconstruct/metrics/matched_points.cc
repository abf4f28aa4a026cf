// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/metrics/matched_points.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

#include "simulate/camera/projection.h"
#include "simulate/core/options.h"

namespace flocklift {
namespace {

// Image position without distortion: truth and result meet the same rays, and nothing can fold.
Vec2d PinholePoint(const Intrinsics& k, const Vec3d& p) {
  return {k.fx * p.x / p.z + k.cx, k.fy * p.y / p.z + k.cy};
}

struct ImagePoint {
  Vec2d point;
  Id id = 0;
};

// The truth of one frame in the image, sorted by u.
using ImageFrame = std::vector<ImagePoint>;

std::unordered_map<int, ImageFrame> ImageOfTruth(const Camera& camera, const Trajectories& truth) {
  std::unordered_map<int, ImageFrame> frames;
  for (const Trajectory& trajectory : truth.trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) {
      const Vec3d in_cam = camera.CamFromWorld(point.frame) * point.position;
      if (!(in_cam.z > 0)) continue;
      frames[point.frame].push_back({PinholePoint(camera.intrinsics, in_cam), trajectory.id});
    }
  }
  for (auto& [frame, points] : frames) {
    std::sort(points.begin(), points.end(),
              [](const ImagePoint& a, const ImagePoint& b) { return a.point.x < b.point.x; });
  }
  return frames;
}

struct NearestAnimal {
  Id id = 0;
  double distance_px = 0;
};

// Of equally near animals the one of the smallest id.
std::optional<NearestAnimal> Nearest(const ImageFrame& frame, const Vec2d& point, double gate_px) {
  std::optional<NearestAnimal> nearest;
  auto candidate = std::lower_bound(frame.begin(), frame.end(), point.x - gate_px,
                                    [](const ImagePoint& p, double u) { return p.point.x < u; });
  for (; candidate != frame.end() && candidate->point.x <= point.x + gate_px; ++candidate) {
    const double distance = std::hypot(candidate->point.x - point.x, candidate->point.y - point.y);
    if (distance >= gate_px) continue;
    if (!nearest || distance < nearest->distance_px ||
        (distance == nearest->distance_px && candidate->id < nearest->id)) {
      nearest = {candidate->id, distance};
    }
  }
  return nearest;
}

struct Claim {
  const TrajectoryPoint* point = nullptr;
  Id result_id = 0;
  double distance_px = 0;
};

// By animal, then frame: the result point that stands for it.
using Claims = std::map<Id, std::unordered_map<int, Claim>>;

// The result rows of one id go to the animal with most votes; where two fragments claim the same
// row, the nearer one in the image gets it.
Claims ClaimByImage(const MatchOptions& options, const Camera& camera, const Trajectories& truth,
                    const Trajectories& result) {
  const auto truth_in_image = ImageOfTruth(camera, truth);
  Claims claims;
  for (const Trajectory& trajectory : result.trajectories) {
    std::vector<std::pair<Id, int>> votes;                     // in the order of the first vote
    std::vector<double> distance_px(trajectory.points.size(),  // to whichever animal is nearest
                                    options.gate_px);
    for (std::size_t k = 0; k < trajectory.points.size(); ++k) {
      const TrajectoryPoint& point = trajectory.points[k];
      const auto frame = truth_in_image.find(point.frame);
      const Vec3d in_cam = camera.CamFromWorld(point.frame) * point.position;
      if (frame == truth_in_image.end() || !(in_cam.z > 0)) continue;
      const auto nearest =
          Nearest(frame->second, PinholePoint(camera.intrinsics, in_cam), options.gate_px);
      if (!nearest) continue;
      distance_px[k] = nearest->distance_px;
      const auto vote = std::find_if(votes.begin(), votes.end(),
                                     [&](const auto& v) { return v.first == nearest->id; });
      if (vote == votes.end()) {
        votes.emplace_back(nearest->id, 1);
      } else {
        ++vote->second;
      }
    }
    if (votes.empty()) continue;
    const Id owner = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
                       return a.second < b.second;
                     })->first;
    auto& rows = claims[owner];
    for (std::size_t k = 0; k < trajectory.points.size(); ++k) {
      const TrajectoryPoint& point = trajectory.points[k];
      const Claim claim{&point, trajectory.id, distance_px[k]};
      const auto [row, is_new] = rows.emplace(point.frame, claim);
      if (!is_new && claim.distance_px < row->second.distance_px) row->second = claim;
    }
  }
  return claims;
}

Claims ClaimById(const Trajectories& result) {
  Claims claims;
  for (const Trajectory& trajectory : result.trajectories) {
    auto& rows = claims[trajectory.id];
    for (const TrajectoryPoint& point : trajectory.points) {
      rows.emplace(point.frame, Claim{&point, trajectory.id, 0});
    }
  }
  return claims;
}

bool InView(const Camera& camera, const Vec3d& in_cam) {
  if (!(in_cam.z > 0) || camera.width <= 0 || camera.height <= 0) return false;
  const Vec2d p = Project(camera.intrinsics, in_cam);
  return p.x >= -0.5 && p.y >= -0.5 && p.x <= camera.width - 0.5 && p.y <= camera.height - 0.5;
}

}  // namespace

MatchedTrajectories MatchTrajectories(const MatchOptions& options, const Camera& camera,
                                      const Trajectories& truth, const Trajectories& result) {
  CheckOptions(options);
  const Claims claims =
      options.by_image ? ClaimByImage(options, camera, truth, result) : ClaimById(result);
  MatchedTrajectories matched;
  for (const Trajectory& trajectory : truth.trajectories) {
    const auto rows = claims.find(trajectory.id);
    for (const TrajectoryPoint& point : trajectory.points) {
      ++matched.truth_rows;
      const Rigid3d cam_from_world = camera.CamFromWorld(point.frame);
      const Vec3d truth_in_cam = cam_from_world * point.position;
      const bool in_view = InView(camera, truth_in_cam);
      if (in_view) ++matched.truth_rows_in_view;
      if (rows == claims.end() || !(truth_in_cam.z > 0)) continue;
      const auto claim = rows->second.find(point.frame);
      if (claim == rows->second.end()) continue;
      const TrajectoryPoint& other = *claim->second.point;
      if (in_view) ++matched.matched_rows_in_view;
      matched.points.push_back({point.frame, trajectory.id, claim->second.result_id, point.position,
                                other.position, truth_in_cam.z, (cam_from_world * other.position).z,
                                result.has_sd_depth ? other.sd_depth : 0});
    }
  }
  return matched;
}

Trajectories WorldFromCamera(const Camera& camera, const Trajectories& in_camera) {
  Trajectories in_world = in_camera;
  for (Trajectory& trajectory : in_world.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) {
      const Rigid3d world_from_cam = camera.CamFromWorld(point.frame).Inverse();
      point.position = world_from_cam * point.position;
      point.velocity = world_from_cam.rotation * point.velocity;
    }
  }
  return in_world;
}

}  // namespace flocklift
