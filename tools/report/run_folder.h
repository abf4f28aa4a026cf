// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the commands left in a folder, read into memory for the report: whatever is there of tracks,
// trajectories, camera, parameters, kernels, replay, summaries, and the truth beside them.

#ifndef FLOCKLIFT_TOOLS_REPORT_RUN_FOLDER_H_
#define FLOCKLIFT_TOOLS_REPORT_RUN_FOLDER_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/observations.h"
#include "simulate/core/parameters.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct StageSummary {
  std::string stage;  // "track", "reconstruct" ..
  nlohmann::ordered_json json;
};

// The tables of a folder, CSV or HDF5; empty: there is none.
struct RunTables {
  std::filesystem::path tracks, shapes, trajectories, true_trajectories;
};

struct RunFolder {
  std::filesystem::path folder;
  std::optional<double> fps;  // [1/s]
  RunTables tables;
  std::optional<Camera> camera;
  std::filesystem::path camera_file;  // empty: none
  std::optional<Tracks> tracks;
  std::optional<Trajectories> trajectories;  // velocities filled where fps is known
  std::optional<Parameters> parameters;
  std::string kernels_picture, kernels_table;  // kernels.svg and kernels.csv as text; or empty
  std::optional<Trajectories> replay;
  std::optional<Tracks> true_tracks;
  std::optional<Trajectories> true_trajectories;
  std::vector<StageSummary> summaries;  // in the order of the stages
  nlohmann::ordered_json scores;        // of scores.json; null when there is none
  std::optional<std::filesystem::path> video;
  std::vector<std::filesystem::path> files;  // all that were read, the video not among them

  // A figure of a stage's summary; null when there is none.
  const nlohmann::ordered_json& Figure(const std::string& stage, const std::string& name) const;
  double TimeOf(int frame) const;  // [s], or the frame's number where fps is not known
  const char* TimeLabel() const;
};

// `truth`: the folder of the truth; not given: DIR/truth or DIR/../truth, if there. `fps` overrides
// what the files say. Throws InputError for a folder that is none or holds nothing to report, and
// for a file that is damaged. Without `reads_tables` the rows of tracks and trajectories stay in
// their files, and what they say of fps is not known.
RunFolder ReadRunFolder(const std::filesystem::path& folder,
                        const std::optional<std::filesystem::path>& truth,
                        std::optional<double> fps, bool reads_tables = true);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPORT_RUN_FOLDER_H_
