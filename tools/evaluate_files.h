// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A result file against a truth file: two track files, or two trajectory files.

#ifndef FLOCKLIFT_TOOLS_EVALUATE_FILES_H_
#define FLOCKLIFT_TOOLS_EVALUATE_FILES_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/metrics/matched_points.h"
#include "track/metrics/scored_frames.h"

namespace flocklift {

enum class FileKind { kTracks, kTrajectories };

// By content: a CSV whose first row is a header holds trajectories, one whose first row is numbers
// holds tracks; an HDF5 file tells by its group. Throws InputError when the file cannot be read.
FileKind KindOfFile(const std::filesystem::path& path);

struct EvaluationOptions {
  TrackScoreOptions tracks;
  MatchOptions match;
  bool truth_in_camera_frame = false;  // trajectories: else in the world frame
  bool result_in_camera_frame = false;
  std::optional<double> scale_sd;  // relative sd of the common scale; absent: from the summary
                                   // of `reconstruct` beside the result, if it is there
};

// Figures by name. `warnings` takes what a reader of the figures should know.
nlohmann::ordered_json EvaluateTracks(const EvaluationOptions& options,
                                      const std::filesystem::path& truth,
                                      const std::filesystem::path& result,
                                      std::vector<std::string>* warnings);

// Without a camera, the world is taken as the camera's own axes: depth is z.
nlohmann::ordered_json EvaluateTrajectories(const EvaluationOptions& options,
                                            const std::optional<std::filesystem::path>& camera,
                                            const std::filesystem::path& truth,
                                            const std::filesystem::path& result,
                                            std::vector<std::string>* warnings);

// figures.scale_sd of summary.reconstruct.json in the folder, if it is there and positive.
std::optional<double> ScaleSdOfSummary(const std::filesystem::path& folder);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_EVALUATE_FILES_H_
