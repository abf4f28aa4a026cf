// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/track_command.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "tools/stage.h"
#include "tools/track_overlay.h"
#include "track/correct.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

void SetFigures(const TrackerReport& report, const Tracks& tracks, Stage* stage) {
  const TrackerTimings& t = report.timings;
  stage->figures() = {
      {"frames_per_second", static_cast<double>(report.frames) / std::max(t.total_s, 1e-9)},
      {"ids", tracks.tracklets.size()},
      {"frames", report.frames},
      {"detections", report.detections},
      {"rows", report.rows},
      {"shared_rows", report.shared_rows},
      {"interpolated_rows", report.filled_rows},
      {"joins", report.joins},
      {"exchanges", report.exchanges},
      {"still_tracks_dropped", report.still_tracks},
      {"polarity", report.dark ? (report.bright ? "both" : "dark") : "bright"},
      {"usual_length_px", report.usual_length_px},
      {"usual_contrast", report.usual_contrast},
      {"process_noise_sizes", report.noise.acceleration},
      {"measurement_noise_sizes", report.noise.measurement},
      {"speed_sd_px_per_frame", report.noise.speed_sd},
      {"part_seconds",
       {{"decode", t.decode_s},
        {"detect", t.detect_s},
        {"associate", t.associate_s},
        {"finish", t.finish_s}}}};
}

}  // namespace

void RunTrack(const TrackCommand& command, const CommonOptions& common) {
  { const VideoSource readable(command.video); }  // fails early, and says what is wrong
  std::vector<Correction> corrections;
  if (!command.corrections.empty()) corrections = ReadCorrections(command.corrections);

  Stage stage("track", common);
  stage.options() = OptionsAsJson(command.tracker);
  stage.options()["overlay"] = command.overlay;
  if (common.fps) stage.options()["fps"] = *common.fps;
  const bool is_pattern = !fs::exists(command.video);
  const fs::path folder = command.video.parent_path();
  stage.AddInput(!is_pattern ? command.video : folder.empty() ? fs::path(".") : folder);
  if (!command.corrections.empty()) stage.AddInput(command.corrections);
  stage.AddOutput("tracks.csv");
  stage.AddOutput("shapes.csv");
  if (command.overlay) stage.AddOutput("overlay.mp4");
  if (stage.IsUpToDate()) return;

  const Progress progress = stage.BeginPhase("track");
  TrackerResult result = TrackVideo(command.tracker, command.video, progress, common.fps);
  if (!corrections.empty()) {
    stage.BeginPhase("correct");
    ApplyCorrections(corrections, command.corrections.string(),
                     static_cast<int>(result.report.frames), &result.tracks);
  }
  for (const std::string& warning : result.report.warnings) stage.Warn(warning);
  if (result.tracks.tracklets.empty()) {
    stage.Warn("no animal was found: lower --threshold, or set --polarity and --window");
  }

  if (command.overlay) {
    const Progress overlay_progress = stage.BeginPhase("overlay");
    WriteTrackOverlay(command.video, result.tracks, common.out / "overlay.mp4", overlay_progress);
  }
  stage.BeginPhase("write", "files");
  WriteTracks(common.out / "tracks.csv", result.tracks);
  WriteShapes(common.out / "shapes.csv", result.tracks);
  SetFigures(result.report, result.tracks, &stage);
  stage.Finish();
}

void AddTrackCommand(CLI::App& app) {
  std::shared_ptr<TrackCommand> command;
  CLI::App* sub = AddSubcommand<TrackCommand>(
      app, "track", "Follow the animals of a video in the picture",
      "Examples:\n"
      "  flocklift track flock.mp4 --out run\n"
      "  flocklift track 'frames/img_%04d.png' --fps 30 --overlay --out run\n"
      "  flocklift track flock.mp4 --corrections corrections.txt --out run",
      {.fps = true}, &RunTrack, &command);
  sub->add_option("video", command->video,
                  "a video file, a pattern of pictures (img_%04d.png) or a folder of pictures")
      ->required();
  sub->add_flag("--overlay", command->overlay, "write overlay.mp4: the tracks over the footage");
  sub->add_option(
      "--corrections", command->corrections,
      "a file of corrections, one a line: swap ID ID FRAME, split ID FRAME, join ID ID, "
      "delete ID [FIRST LAST], pin ID FRAME X Y, add FRAME X Y");
  AddFlags(*sub, command->tracker, "Tracking");
}

}  // namespace flocklift
