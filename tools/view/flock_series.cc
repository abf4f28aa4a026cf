// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/flock_series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reconstruct/metrics/flock_statistics.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;

// Four digits are more than a curve shows.
Json Rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == 0) return 0;
  const double scale = std::pow(10.0, 4 - std::ceil(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

Json MedianOf(std::vector<double>* values) {
  if (values->empty()) return nullptr;
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return Rounded(*middle);
}

Vec3d At(const std::vector<float>& column, std::size_t row) {
  return {column[3 * row], column[3 * row + 1], column[3 * row + 2]};
}

// One frame of the table.
struct FrameView {
  int frame = 0;
  std::size_t first = 0;
  std::vector<Vec3d> position, velocity;
  std::vector<double> depth;

  FrameView(const TrajectoryTable& table, int k, const std::optional<Camera>& camera)
      : frame(table.rows.first_frame + k), first(table.rows.start[static_cast<std::size_t>(k)]) {
    const std::size_t end = table.rows.start[static_cast<std::size_t>(k) + 1];
    const Rigid3d cam_from_world = camera ? camera->CamFromWorld(frame) : Rigid3d{};
    for (std::size_t row = first; row < end; ++row) {
      position.push_back(At(table.position, row));
      velocity.push_back(At(table.velocity, row));
      depth.push_back((cam_from_world * position.back()).z);
    }
  }
};

}  // namespace

Json FlockSeries(const TrajectoryTable& table, const std::optional<Camera>& camera) {
  Json json;
  for (const char* name : {"frames", "depth", "speed", "neighbour", "polarisation"}) {
    json[name] = Json::array();
  }
  for (int k = 0; k < table.rows.frame_count(); ++k) {
    FrameView view(table, k, camera);
    if (view.position.empty()) continue;
    std::vector<double> speeds;
    for (const Vec3d& v : view.velocity) speeds.push_back(Norm(v));
    std::vector<double> distances = NearestNeighbourDistances(view.position);
    const auto polarisation = Polarisation(view.velocity);
    json["frames"].push_back(view.frame);
    json["depth"].push_back(MedianOf(&view.depth));
    json["speed"].push_back(MedianOf(&speeds));
    json["neighbour"].push_back(MedianOf(&distances));
    json["polarisation"].push_back(polarisation ? Rounded(*polarisation) : Json(nullptr));
  }
  return json;
}

Json AnimalSeries(const TrajectoryTable& table, const std::optional<Camera>& camera,
                  std::uint32_t animal) {
  Json json;
  for (const char* name : {"frames", "depth", "sd_depth", "speed", "neighbour", "polarisation"}) {
    json[name] = Json::array();
  }
  for (int k = 0; k < table.rows.frame_count(); ++k) {
    const auto first = table.rows.animal.begin() + table.rows.start[static_cast<std::size_t>(k)];
    const auto end = table.rows.animal.begin() + table.rows.start[static_cast<std::size_t>(k) + 1];
    const auto found = std::lower_bound(first, end, animal);  // by animal within a frame
    if (found == end || *found != animal) continue;
    const FrameView view(table, k, camera);
    const auto mine = static_cast<std::size_t>(found - first);
    double nearest = std::numeric_limits<double>::infinity();
    const Vec3d direction = Normalized(view.velocity[mine]);
    Vec3d mean;
    int others = 0;
    for (std::size_t j = 0; j < view.position.size(); ++j) {
      if (j == mine) continue;
      nearest = std::min(nearest, Norm(view.position[j] - view.position[mine]));
      mean += Normalized(view.velocity[j]);
      ++others;
    }
    json["frames"].push_back(view.frame);
    json["depth"].push_back(Rounded(view.depth[mine]));
    json["sd_depth"].push_back(Rounded(table.sd_depth[view.first + mine]));
    json["speed"].push_back(Rounded(Norm(view.velocity[mine])));
    json["neighbour"].push_back(Rounded(nearest));
    // How far it flies with the others: the cosine to their mean direction.
    json["polarisation"].push_back(others > 0 ? Rounded(Dot(direction, Normalized(mean)))
                                              : Json(nullptr));
  }
  return json;
}

}  // namespace flocklift
