// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/track_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "tools/size_text.h"
#include "tools/stage.h"
#include "tools/track_overlay.h"
#include "track/correct.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

void SetFigures(const TrackerReport& report, const Tracks& tracks, Stage* stage) {
  const TrackerTimings& t = report.timings;
  nlohmann::ordered_json figures = {
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
  stage->figures().update(figures);
}

struct PictureSize {
  double width = 0, height = 0;
};

// The video's, what the flag says, or that of a picture which holds all the boxes.
PictureSize SizeOf(const TrackCommand& command, const ForeignTracks& foreign) {
  if (!command.video.empty()) {
    const VideoSource video(command.video);
    return {static_cast<double>(video.width()), static_cast<double>(video.height())};
  }
  if (!command.size.empty()) {
    const auto [width, height] = ParseSize(command.size, "--size");
    return {static_cast<double>(width), static_cast<double>(height)};
  }
  PictureSize size{1, 1};
  const auto hold = [&size](const Detection& d) {
    size.width = std::max(size.width, d.box.left + d.box.width);
    size.height = std::max(size.height, d.box.top + d.box.height);
  };
  for (const Tracklet& t : foreign.tracks.tracklets) {
    std::for_each(t.detections.begin(), t.detections.end(), hold);
  }
  for (const DetectionFrame& f : foreign.detections) {
    std::for_each(f.detections.begin(), f.detections.end(), hold);
  }
  return size;
}

// Goes on from what another program found.
TrackerResult TrackFrom(const TrackCommand& command, const CommonOptions& common, Stage* stage) {
  ForeignTracks foreign = ReadForeignTracks(command.from, command.foreign);
  const PictureSize size = SizeOf(command, foreign);
  std::optional<double> fps = common.fps ? common.fps : foreign.tracks.fps;
  if (!fps && !command.video.empty()) fps = VideoSource(command.video).fps();
  foreign.tracks.fps = fps;
  TrackerResult result =
      foreign.has_ids
          ? ContinueTracks(command.tracker, foreign.tracks, size.width, size.height)
          : TrackDetections(command.tracker, foreign.detections, size.width, size.height, fps);
  if (!foreign.has_boxes) {
    for (Tracklet& t : result.tracks.tracklets) {
      for (Detection& d : t.detections) d.shape.reset();
    }
    stage->Warn(
        fmt::format("the {} file has positions only: all boxes are {:g} px wide; use "
                    "--no-size when you reconstruct",
                    foreign.layout, command.foreign.box));
  }
  stage->figures()["layout"] = foreign.layout;
  return result;
}

// The last frame of the footage, as far as it is known.
int FrameCount(const TrackerResult& result) {
  int last = static_cast<int>(result.report.frames);
  for (const Tracklet& t : result.tracks.tracklets) {
    if (!t.detections.empty()) last = std::max(last, t.detections.back().frame);
  }
  return last;
}

}  // namespace

void RunTrack(const TrackCommand& command, const CommonOptions& common) {
  const bool has_video = !command.video.empty();
  if (!has_video && command.from.empty()) {
    throw CLI::ValidationError("track", "give a video, or --from with what another program found");
  }
  if (!has_video && command.overlay) {
    throw CLI::ValidationError("--overlay", "there is no video to draw over");
  }
  if (has_video) const VideoSource readable(command.video);  // fails early, says what is wrong
  std::vector<Correction> corrections;
  if (!command.corrections.empty()) corrections = ReadCorrections(command.corrections);

  Stage stage("track", common);
  stage.options() = OptionsAsJson(command.tracker);
  stage.options()["overlay"] = command.overlay;
  if (common.fps) stage.options()["fps"] = *common.fps;
  if (has_video) {
    const bool is_pattern = !fs::exists(command.video);
    const fs::path folder = command.video.parent_path();
    stage.AddInput(!is_pattern ? command.video : folder.empty() ? fs::path(".") : folder);
  }
  if (!command.from.empty()) {
    stage.options().update(OptionsAsJson(command.foreign));
    stage.options()["size"] = command.size;
    stage.AddInput(command.from);
  }
  if (!command.corrections.empty()) stage.AddInput(command.corrections);
  stage.AddOutput("tracks.csv");
  stage.AddOutput("shapes.csv");
  if (command.overlay) stage.AddOutput("overlay.mp4");
  if (stage.IsUpToDate()) return;

  const Progress progress = stage.BeginPhase("track");
  TrackerResult result = command.from.empty()
                             ? TrackVideo(command.tracker, command.video, progress, common.fps)
                             : TrackFrom(command, common, &stage);
  if (!corrections.empty()) {
    stage.BeginPhase("correct");
    ApplyCorrections(corrections, command.corrections.string(), FrameCount(result), &result.tracks);
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
      "  flocklift track flock.mp4 --corrections corrections.txt --out run\n"
      "  flocklift track flock.mp4 --from trackpy.csv --out run",
      {.fps = true}, &RunTrack, &command);
  sub->add_option("video", command->video,
                  "a video file, a pattern of pictures (img_%04d.png) or a folder of pictures");
  sub->add_option("--from", command->from,
                  "go on from detections or tracks of another program: a MOTChallenge, trackpy, "
                  "DLTdv, TRex or idtracker.ai file, or the folder of one of the last two");
  sub->add_option("--size", command->size, "WIDTHxHEIGHT of the picture, where no video is given");
  AddFlags(*sub, command->foreign, "Other programs' files", "from-");
  sub->add_flag("--overlay", command->overlay, "write overlay.mp4: the tracks over the footage");
  sub->add_option(
      "--corrections", command->corrections,
      "a file of corrections, one a line: swap ID ID FRAME, split ID FRAME, join ID ID, "
      "delete ID [FIRST LAST], pin ID FRAME X Y, add FRAME X Y");
  AddFlags(*sub, command->tracker, "Tracking");
}

}  // namespace flocklift
