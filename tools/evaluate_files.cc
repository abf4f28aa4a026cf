// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/evaluate_files.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <fstream>

#include "reconstruct/metrics/order_statistics.h"
#include "reconstruct/metrics/trajectory_scores.h"
#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "track/metrics/track_scores.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

bool HasHeader(const fs::path& path) {
  std::ifstream file(path);
  if (!file || fs::is_directory(path)) {
    throw InputError(path.string(), 0, "cannot be read", "check that the file is there");
  }
  std::string line;
  while (std::getline(file, line)) {
    const std::size_t first = line.find_first_not_of(" \t\r\xEF\xBB\xBF");
    if (first == std::string::npos || line[first] == '#') continue;
    return std::isalpha(static_cast<unsigned char>(line[first])) != 0 || line[first] == '"';
  }
  return false;
}

Json AsJson(const std::vector<std::pair<std::string, double>>& figures) {
  Json json = Json::object();
  for (const auto& [name, value] : figures) {
    // Counts without a decimal point.
    if (value == std::floor(value) && std::abs(value) < 1e15) {
      json[name] = static_cast<std::int64_t>(value);
    } else {
      json[name] = value;
    }
  }
  return json;
}

// Ids that name other animals in the two files show as matched points far apart in the image.
void WarnOfForeignIds(const Camera& camera, const MatchedTrajectories& matched,
                      std::vector<std::string>* warnings) {
  std::vector<double> angles;  // between the rays of the two points [rad]
  for (const MatchedPoint& point : matched.points) {
    const Rigid3d cam_from_world = camera.CamFromWorld(point.frame);
    const Vec3d a = cam_from_world * point.truth_in_world;
    const Vec3d b = cam_from_world * point.result_in_world;
    angles.push_back(std::atan2(Norm(Cross(a, b)), Dot(a, b)));
  }
  constexpr double kForeign = 0.02;  // 20 px at a focal length of 1000 px
  if (const auto median = Median(std::move(angles)); median && *median > kForeign) {
    warnings->push_back(
        "the ids of truth and result seem to name different animals (their rays differ by " +
        fmt::format("{:.1f}", *median * 180 / 3.14159265358979) +
        " degrees in the median): try --match image");
  }
}

}  // namespace

FileKind KindOfFile(const fs::path& path) {
  if (path.extension() == ".h5") {
    try {
      ReadTracks(path);
      return FileKind::kTracks;
    } catch (const InputError&) {
      return FileKind::kTrajectories;  // whose reader says what is wrong, if anything is
    }
  }
  return HasHeader(path) ? FileKind::kTrajectories : FileKind::kTracks;
}

std::optional<double> ScaleSdOfSummary(const fs::path& folder) {
  std::ifstream file(folder / "summary.reconstruct.json");
  if (!file) return std::nullopt;
  const Json summary = Json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!summary.is_object() || !summary.contains("figures")) return std::nullopt;
  const Json& figures = summary.at("figures");
  if (!figures.is_object() || !figures.contains("scale_sd")) return std::nullopt;
  const Json& scale_sd = figures.at("scale_sd");
  if (!scale_sd.is_number() || !(scale_sd.get<double>() > 0)) return std::nullopt;
  return scale_sd.get<double>();
}

Json EvaluateTracks(const EvaluationOptions& options, const fs::path& truth, const fs::path& result,
                    std::vector<std::string>* warnings) {
  const Tracks truth_tracks = ReadTracks(truth), result_tracks = ReadTracks(result);
  if (truth_tracks.tracklets.empty()) warnings->push_back("the truth has no tracks");
  if (result_tracks.tracklets.empty()) warnings->push_back("the result has no tracks");
  return AsJson(Figures(ScoreTracks(options.tracks, truth_tracks, result_tracks)));
}

Json EvaluateTrajectories(const EvaluationOptions& options, const std::optional<fs::path>& camera,
                          const fs::path& truth, const fs::path& result,
                          std::vector<std::string>* warnings) {
  Check(camera || !options.match.by_image, "--match image needs --camera");
  Camera view;
  if (camera) {
    view = ReadCamera(*camera);
  } else {
    warnings->push_back("no camera: the world's z is taken as depth; give --camera");
  }
  Trajectories true_paths = ReadTrajectories(truth), result_paths = ReadTrajectories(result);
  if (options.truth_in_camera_frame) true_paths = WorldFromCamera(view, true_paths);
  if (options.result_in_camera_frame) result_paths = WorldFromCamera(view, result_paths);
  const MatchedTrajectories matched =
      MatchTrajectories(options.match, view, true_paths, result_paths);
  const auto scale_sd =
      options.scale_sd ? options.scale_sd : ScaleSdOfSummary(fs::absolute(result).parent_path());
  const auto scores = ScoreTrajectories(matched, scale_sd);
  if (!scores) {
    warnings->push_back(options.match.by_image
                            ? "no row of the truth has a result near it in the image"
                            : "no row of the truth has a result of its id: try --match image");
    return AsJson({{"rows", 0}, {"coverage", 0}});
  }
  if (!options.match.by_image) WarnOfForeignIds(view, matched, warnings);
  return AsJson(Figures(*scores));
}

}  // namespace flocklift
